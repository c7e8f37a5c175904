import { convertToTexture, vec4 } from 'three/tsl'
import { Node, NodeUpdateType } from 'three/webgpu'
import type { NodeFrame, TextureNode } from 'three/webgpu'
import { checkBoolean, checkFinite, checkNonNegative, fail, setOptions } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { checkRange } from '../check'
import { checkAtmosphere } from '../view/ViewNodes'
import { adaptedScale, exposedScale, type MeteredLuminance } from './cpu/exposedScale'
import { cellWeights, meteredLogLuminance, meterForm } from './cpu/meteredLuminance'
import { ExposedNode } from './ExposedNode'
import { ExposureMeter, type MeterReading } from './ExposureMeter'
import { purkinjeShift } from './tsl/purkinjeShift'
import type { Vec4 } from '../tsl-types'
import { number } from '../uniforms'

/** Options of {@link AutoExposureNode}. */
export interface AutoExposureOptions {
  /** See {@link AutoExposureNode.compensation}; by default 0. */
  compensation?: number
  /** See {@link AutoExposureNode.limits}; by default [1e-4, 1e9]. */
  limits?: readonly [number, number]
  /** See {@link AutoExposureNode.percentiles}; by default [0.1, 0.97]. */
  percentiles?: readonly [number, number]
  /** See {@link AutoExposureNode.centerWeight}; by default 0.5. */
  centerWeight?: number
  /** See {@link AutoExposureNode.highlightPriority}; by default 0.6. */
  highlightPriority?: number
  /** See {@link AutoExposureNode.lightSeconds}; by default 0.4. */
  lightSeconds?: number
  /** See {@link AutoExposureNode.darkSeconds}; by default 1.2. */
  darkSeconds?: number
  /** See {@link AutoExposureNode.darkNights}; by default true. */
  darkNights?: boolean
  /** See {@link AutoExposureNode.purkinjeShift}; by default 1. */
  purkinjeShift?: number
}

const WHERE = 'AutoExposureNode'

const SETTINGS = [
  'compensation',
  'limits',
  'percentiles',
  'centerWeight',
  'highlightPriority',
  'lightSeconds',
  'darkSeconds',
  'darkNights',
  'purkinjeShift'
] as const

/** Luminance that eyes are adapted to before the first reading, daylight's [cd/m²]. */
const DAYLIGHT = 5000

/** @throws If they are not two numbers from `min` to `max` that rise. */
function checkRising(
  name: string,
  values: readonly [number, number],
  min: number,
  max: number
): void {
  if (!Array.isArray(values) || values.length !== 2) {
    fail(WHERE, `${name} must be an array of 2 numbers`, values)
  }
  values.forEach((value, i) => checkRange(WHERE, `${name}[${i}]`, value, min, max))
  if (!(values[1] > values[0])) fail(WHERE, `${name} must rise`, values)
}

/**
 * Automatic exposure: meters what a camera sees and sets the atmosphere's `luminanceScale`, so that half floats hold
 * noon and night.
 *
 * ```ts
 * const exposure = autoExposure(color, atmosphere)
 * pipeline.outputNode = exposure
 * // per frame
 * exposure.adapt(deltaSeconds)
 * pipeline.render()
 * ```
 *
 * Put it after air and clouds, before bloom; by day the picture passes unchanged, by night as eyes see it:
 * {@link purkinjeShift}. A scene whose materials draw the air themselves has `pass(scene, camera)` as colour. What is no texture yet is drawn to one of the picture's size.
 *
 * From a histogram of log2 luminance the mean between two {@link percentiles} becomes 0.17, less where a large part is much
 * brighter ({@link highlightPriority}), and the upper percentile no more than 8: for tone mappings with soft highlights, such as
 * `AgXToneMapping` and `ACESFilmicToneMapping`. What is over 8 stops darker than the upper percentile counts less and over 12 not at all.
 * Beside such black the rest is shown brighter, until its brightest tenth is at 0.6. The picture is read back a frame or more later, without a wait, one at a time.
 *
 * `luminanceScale` is that of all cameras, so an atmosphere has one of these. Lamps and emissive materials of your own
 * must follow it, or they are metered wrong, too.
 */
export class AutoExposureNode extends Node<'vec4'> {
  static get type(): string {
    return 'AutoExposureNode'
  }

  /** Colour that is metered, linear, in the unit of the atmosphere's nodes. */
  readonly colorNode: Node
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  readonly #picture: TextureNode
  readonly #meter = new ExposureMeter()
  #reading: MeterReading | null = null
  #luminance: MeteredLuminance | null = null
  /** True if nothing was seen in the reading. */
  #isBlack = false
  /** False before the first scale for a picture that is not black. */
  #hasAdapted = false
  #weights = cellWeights(0.5)
  #compensation = 0
  #limits: readonly [number, number] = [1e-4, 1e9]
  #percentiles: readonly [number, number] = [0.1, 0.97]
  #centerWeight = 0.5
  #highlightPriority = 0.6
  #lightSeconds = 0.4
  #darkSeconds = 1.2
  #darkNights = true
  #purkinjeShift = 1
  readonly #sight = { luminanceScale: number(1), adaptation: number(DAYLIGHT), strength: number() }

  /** @throws If an argument is missing or of the wrong kind, or an option is unknown or out of range. */
  constructor(colorNode: Node, atmosphere: Atmosphere, options: AutoExposureOptions = {}) {
    super('vec4')
    if (!colorNode?.isNode) fail(WHERE, 'colorNode must be a node', colorNode)
    checkAtmosphere(WHERE, atmosphere)
    this.colorNode = colorNode
    this.atmosphere = atmosphere
    this.#picture = convertToTexture(colorNode)
    this.updateBeforeType = NodeUpdateType.FRAME
    this.set(options)
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or refused; then nothing has changed.
   */
  set(settings: AutoExposureOptions): this {
    return setOptions(WHERE, this, settings, ...SETTINGS)
  }

  /** Brightness over what is metered; 1 doubles it [EV]. */
  get compensation(): number {
    return this.#compensation
  }

  set compensation(value: number) {
    checkFinite(WHERE, 'compensation', value)
    this.#compensation = value
  }

  /** Least and greatest luminance that is exposed for; what is darker or brighter shows as that, > 0 [cd/m²]. */
  get limits(): readonly [number, number] {
    return this.#limits
  }

  set limits(value: readonly [number, number]) {
    checkRising('limits', value, 1e-9, 1e12)
    this.#limits = [...value]
  }

  /** Parts of the picture, from dark to bright, between which luminance is averaged, in [0, 1]. */
  get percentiles(): readonly [number, number] {
    return this.#percentiles
  }

  set percentiles(value: readonly [number, number]) {
    checkRising('percentiles', value, 0, 1)
    this.#percentiles = [...value]
    this.#evaluate()
  }

  /** Weight of the middle of the picture, in [0, 1]: 0 meters evenly, 1 the middle alone [–]. */
  get centerWeight(): number {
    return this.#centerWeight
  }

  set centerWeight(value: number) {
    checkRange(WHERE, 'centerWeight', value, 0, 1)
    this.#centerWeight = value
    this.#weights = cellWeights(value)
    this.#evaluate()
  }

  /**
   * Part, in [0, 1], of the stops by which the brightest tenth of the picture is over 0.8: the picture is darkened by it. At 0 the sky over
   * a valley after sunset goes white, at 1 the land stays dark [–].
   */
  get highlightPriority(): number {
    return this.#highlightPriority
  }

  set highlightPriority(value: number) {
    checkRange(WHERE, 'highlightPriority', value, 0, 1)
    this.#highlightPriority = value
  }

  /** Time in which 63 % of the stops to a brighter scene are taken, ≥ 0; 0 adapts at once [s]. */
  get lightSeconds(): number {
    return this.#lightSeconds
  }

  set lightSeconds(value: number) {
    checkNonNegative(WHERE, 'lightSeconds', value)
    this.#lightSeconds = value
  }

  /** Time in which 63 % of the stops to a darker scene are taken, ≥ 0; 0 adapts at once [s]. */
  get darkSeconds(): number {
    return this.#darkSeconds
  }

  set darkSeconds(value: number) {
    checkNonNegative(WHERE, 'darkSeconds', value)
    this.#darkSeconds = value
  }

  /**
   * Shows dark scenes darker, as eyes see them: a tenth of daylight's brightness by moonlight, a twentieth under stars
   * alone. False shows a night like a day.
   */
  get darkNights(): boolean {
    return this.#darkNights
  }

  set darkNights(value: boolean) {
    checkBoolean(WHERE, 'darkNights', value)
    this.#darkNights = value
  }

  /**
   * Strength, in [0, 1], by which night scenes lose their colours to a bluish grey, as rods see them: fully below
   * 0.005 cd/m², less up to 5 cd/m². 0 shows moonlight as warm as a camera does. None without {@link darkNights} [–].
   */
  get purkinjeShift(): number {
    return this.#purkinjeShift
  }

  set purkinjeShift(value: number) {
    checkRange(WHERE, 'purkinjeShift', value, 0, 1)
    this.#purkinjeShift = value
  }

  /** Luminance last metered; null before the first reading [cd/m²]. */
  get luminance(): number | null {
    return this.#luminance?.mean ?? null
  }

  /** `luminanceScale` that is adapted to; null before the first reading [1/(cd/m²)]. */
  get targetScale(): number | null {
    if (this.#luminance === null) return null
    return exposedScale(this.#luminance, this)
  }

  /**
   * Moves the atmosphere's `luminanceScale` towards what was last metered; the first time all the way.
   *
   * @param deltaSeconds - Time since the last call, ≥ 0 [s].
   * @throws If the time is out of range.
   */
  adapt(deltaSeconds: number): void {
    checkNonNegative(`${WHERE}.adapt`, 'deltaSeconds', deltaSeconds)
    const { atmosphere, targetScale, luminance } = this
    if (targetScale === null || luminance === null) return
    const from = atmosphere.luminanceScale
    const timeConstant = targetScale < from ? this.#lightSeconds : this.#darkSeconds
    atmosphere.luminanceScale = this.#hasAdapted
      ? adaptedScale(from, targetScale, deltaSeconds, timeConstant)
      : targetScale
    const { adaptation } = this.#sight
    adaptation.value = this.#hasAdapted
      ? adaptedScale(adaptation.value, luminance, deltaSeconds, timeConstant)
      : luminance
    // A picture that is black may wait for its first light.
    this.#hasAdapted ||= !this.#isBlack
  }

  /**
   * Adapts at once to the picture last drawn, for stills. From a night's scale to a day's, or back, it takes three
   * pictures: half floats hold neither in the other's.
   *
   * @returns Settles when the picture has been read back.
   */
  async settle(): Promise<void> {
    await this.#meter.reading
    this.#hasAdapted = false
    this.adapt(0)
  }

  override updateBefore({ renderer }: NodeFrame): undefined {
    const { luminanceScale, bakeStepsPerFrame, tables } = this.atmosphere
    this.#sight.luminanceScale.value = luminanceScale
    this.#sight.strength.value = this.#darkNights ? this.#purkinjeShift : 0
    // Skies are black before their tables are baked.
    const isBaking = tables.version === 0 && bakeStepsPerFrame < Infinity
    if (renderer === null || isBaking) return
    this.#meter.meter(renderer, this.#picture.value, luminanceScale, reading => {
      this.#reading = reading
      this.#evaluate()
    })
  }

  #evaluate(): void {
    if (this.#reading === null) return
    const { logs, scale } = this.#reading
    const found = meteredLogLuminance(logs, this.#weights, this.#percentiles)
    this.#isBlack = found.bright <= meterForm.darkest
    // By the scale of that picture: there may be another by now.
    const [mean, light, bright] = [found.mean, found.light, found.bright].map(
      log => 2 ** log / scale
    )
    this.#luminance = { mean, light, bright, seen: found.seen }
  }

  override setup(): Node {
    return this.seen(this.#picture)
  }

  /** A colour as eyes see it that are adapted to the picture. To be called inside of a shader function. */
  seen(color: Vec4): Vec4 {
    return vec4(purkinjeShift(color.rgb, this.#sight), color.a)
  }

  /**
   * Another picture than the metered one, exposed as that: for what is made of it by a post effect that reads its texture, such
   * as motion blur, which needs no texture of the exposed picture then. Something must draw the metered picture.
   *
   * @param colorNode - Linear, in the unit of the atmosphere's nodes.
   */
  exposed(colorNode: Node): Node<'vec4'> {
    return new ExposedNode(this, colorNode)
  }

  /** Frees its textures. It can be used again. */
  override dispose(): void {
    this.#meter.dispose()
    if ('isRTTNode' in this.#picture) this.#picture.dispose()
    this.#hasAdapted = false
    this.#sight.adaptation.value = DAYLIGHT
    this.#reading = this.#luminance = null
    super.dispose()
  }
}

/** Automatic exposure: see {@link AutoExposureNode}. */
export const autoExposure = (
  colorNode: Node,
  atmosphere: Atmosphere,
  options?: AutoExposureOptions
): AutoExposureNode => new AutoExposureNode(colorNode, atmosphere, options)
