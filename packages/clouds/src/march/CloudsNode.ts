import { AtmosphereNode, whereSeen } from '@welkin/atmosphere'
import type { Atmosphere, ScreenShadows, ShadowedShafts } from '@welkin/atmosphere'
import { checkBoolean, checkNonNegative, checkOptions, fail, setOptions } from '@welkin/geo'
import type { Camera, PerspectiveCamera } from 'three'
import { Fn, uniform, uv, vec4 } from 'three/tsl'
import type { Node, NodeBuilder, NodeFrame, Renderer } from 'three/webgpu'
import { checkDepth, checkPrecipitation } from '../check'
import { CloudField, type CloudFieldOptions } from '../density/CloudField'
import type { CloudWorldMap } from '../density/CloudWorldMap'
import type { CloudLayers } from '../layers/CloudLayers'
import { CloudLightTable } from '../light/CloudLightTable'
import type { CloudCaster } from '../light/tsl/shadingContext'
import type { CloudNoise } from '../noise/CloudNoise'
import type { PrecipitationShafts } from '../precipitation/PrecipitationShafts'
import { CloudRenderer, sizeOf } from './CloudRenderer'
import { CloudShadowMap } from '../shadow/CloudShadowMap'
import { FrameUniforms } from './FrameUniforms'
import { depthAt } from './tsl/viewRay'
import {
  cloudQualities,
  QualityUniforms,
  resolveQuality,
  type CloudQuality,
  type CloudQualityName
} from './quality'
import type { Vec4 } from '../tsl-types'

/** Slices of its own noise that a node draws in a frame: all in about 20. */
const NOISE_SLICES = 12

/** Options of {@link clouds}. */
export interface CloudsOptions {
  /** Fineness of the march; by default `'high'`. */
  quality?: CloudQualityName | CloudQuality
  /** See {@link CloudsNode.time}; by default null. */
  time?: number | null
  /** See {@link CloudsNode.nightIlluminance}; by default that of `NightLightProbe`. */
  nightIlluminance?: number
  /** See {@link CloudsNode.ambient}; by default 1. */
  ambient?: number
  /** See {@link CloudsNode.accumulates}; by default true. */
  accumulates?: boolean
  /** Cloud cover of the planet or a part of it: `cloudWorldMap(texture)`; by default none. */
  worldMap?: CloudWorldMap | null
  /**
   * Noise to share between nodes, drawn at once if it is not yet. Left out, the node makes and owns its
   * own, and draws it over its first frames: the sky is clear until then, and clouds grow in the next.
   */
  noise?: CloudNoise
  /** Clouds of one's own in place of weather and noise: see {@link CloudFieldOptions.extinction}. */
  extinction?: CloudFieldOptions['extinction']
  /** Light table to share between nodes; left out, the node makes and owns its own. */
  light?: CloudLightTable
  /** Rain and snow under the clouds: `precipitationShafts()`. Needed once a layer has a rate of `precipitation`, then or later. */
  precipitation?: PrecipitationShafts
}

const SETTINGS = ['quality', 'time', 'nightIlluminance', 'ambient', 'accumulates'] as const

/**
 * Volumetric clouds as a post effect: marched along each line of sight to what was drawn, lit by the
 * atmosphere's sun, sky and ground, in the night by its moon if that was added to it and by the night
 * sky, with the air in front of them.
 *
 * ```ts
 * const scenePass = pass(scene, camera, { samples: 0 })
 * const depth = scenePass.getTextureNode('depth')
 * const air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere)
 * pipeline.outputNode = clouds(air, depth, camera, atmosphere, cloudPreset('fairWeather'))
 * ```
 *
 * A frame marches a part of the pixels and takes the others from the frames before, looked up where the
 * clouds were: draw with one node per camera, and give `depth` as a texture node.
 *
 * Layers may be changed at any time. What is transparent and writes no depth is taken to be where the
 * things behind it are. Knows standard, reversed and logarithmic depth.
 */
export class CloudsNode extends AtmosphereNode {
  static get type(): string {
    return 'CloudsNode'
  }

  /** Colour that was drawn, air and sky included; linear. */
  colorNode: Node
  /** Its depth, as the renderer writes it. */
  depthNode: Node
  /** The camera that drew it. */
  readonly camera: PerspectiveCamera
  /** Density of the clouds, for their own passes and for others'. */
  readonly field: CloudField
  /** Multiple scattering in clouds; shared if it was given, else owned. */
  readonly light: CloudLightTable
  /** Optical depths towards the sun about the camera. */
  readonly shadows: CloudShadowMap
  /** True after `dispose`: it casts no shadows any more. */
  isDisposed = false
  #time: number | null = null
  #accumulates = true
  readonly #ownsLight: boolean
  readonly #precipitation: PrecipitationShafts | undefined
  readonly #noiseSlices: number
  readonly #uniforms = new QualityUniforms()
  readonly #frame = new FrameUniforms()
  #drawnBy: Renderer | null = null
  /** Render targets and passes of the camera's clouds. */
  readonly passes: CloudRenderer
  readonly #exposure = uniform(1)
  /** Layers of the picture with the clouds, drawn by this node: shadows in the air of `cloudAirShadow`, and `lightning`. */
  readonly screens = new Set<
    Pick<ScreenShadows, 'prepare' | 'update' | 'dim'> &
      Partial<Pick<ScreenShadows, 'prepareShadows'>>
  >()
  /** Light shafts that have these clouds' shadows, by `cloudAirShadow`. */
  readonly castsInto = new Set<ShadowedShafts>()
  /** Casters into those of them that have the clouds' camera. */
  readonly casters = new Set<CloudCaster>()
  #quality: CloudQuality = cloudQualities.high

  /** @throws If an argument is missing or of the wrong kind, or layers have precipitation and nothing shows it. */
  constructor(
    colorNode: Node,
    depthNode: Node,
    camera: Camera,
    atmosphere: Atmosphere,
    layers: CloudLayers,
    options: CloudsOptions = {}
  ) {
    if (!(camera as PerspectiveCamera | undefined)?.isPerspectiveCamera) {
      fail('CloudsNode', 'camera must be a PerspectiveCamera', camera)
    }
    super(atmosphere, camera)
    checkOptions(
      'CloudsNode',
      options,
      'worldMap',
      'noise',
      'extinction',
      'light',
      'precipitation',
      ...SETTINGS
    )
    const { worldMap, noise, extinction, light, precipitation, ...settings } = options
    if (!colorNode?.isNode) fail('CloudsNode', 'colorNode must be a node', colorNode)
    checkDepth('CloudsNode', depthNode)
    if (light !== undefined && !(light instanceof CloudLightTable)) {
      fail('CloudsNode', 'light must be a CloudLightTable', light)
    }
    this.colorNode = colorNode
    this.depthNode = depthNode
    this.camera = camera as PerspectiveCamera
    const field = { noise, worldMap, extinction }
    this.field = new CloudField(atmosphere, layers, this.view, field, 'CloudsNode')
    this.set(settings)
    this.light = light ?? new CloudLightTable()
    this.#ownsLight = light === undefined
    this.#precipitation = precipitation
    checkPrecipitation(layers, precipitation)
    this.#noiseSlices = noise === undefined ? NOISE_SLICES : Infinity
    this.shadows = new CloudShadowMap(this.field, precipitation)
    this.passes = new CloudRenderer({
      field: this.field,
      light: this.light.nodes,
      shadows: this.shadows.nodes,
      quality: this.#uniforms,
      precipitation,
      casters: this.casters,
      viewRays: {
        field: this.field,
        frame: this.#frame,
        depthAt: at => depthAt(this.depthNode, at)
      }
    })
  }

  /**
   * Changes some settings.
   * @throws If one is unknown or out of range; then nothing has changed.
   */
  set(settings: Pick<CloudsOptions, (typeof SETTINGS)[number]>): this {
    return setOptions('CloudsNode', this, settings, ...SETTINGS)
  }

  /** Time, by which clouds drift [s]; null, the default, for the renderer's clock. */
  get time(): number | null {
    return this.#time
  }

  /** @throws If it is not finite. */
  set time(seconds: number | null) {
    if (seconds !== null && !Number.isFinite(seconds)) {
      fail('CloudsNode', 'time must be a finite number or null', seconds)
    }
    this.#time = seconds
  }

  /** Temporal accumulation on or off; without it, clouds are coarse. */
  get accumulates(): boolean {
    return this.#accumulates
  }

  /** @throws If it is no boolean. */
  set accumulates(accumulates: boolean) {
    checkBoolean('CloudsNode', 'accumulates', accumulates)
    this.#accumulates = accumulates
  }

  /** Noise that clouds are made of; shared if it was given. */
  get noise(): CloudNoise {
    return this.field.noise
  }

  /** Cloud cover of the whole planet; shared, not owned. */
  get worldMap(): CloudWorldMap | null {
    return this.field.worldMap
  }

  /**
   * Makes all that air and clouds need now: the atmosphere's tables, noise and the light table. Shaders are
   * compiled with the first frame.
   *
   * @param renderer - Renderer, which is initialised first if it is not yet.
   */
  async bake(renderer: Renderer): Promise<void> {
    await this.atmosphere.bake(renderer)
    this.field.bake(renderer)
    this.light.bake()
  }

  /** True once there is noise to make clouds of. Before, the sky is clear; {@link bake} makes all at once. */
  get isReady(): boolean {
    return this.field.isReady
  }

  /** Fineness of the march. */
  get quality(): CloudQuality {
    return this.#quality
  }

  /** @throws If a parameter is out of its range. */
  set quality(quality: CloudQualityName | CloudQuality) {
    this.#quality = resolveQuality('CloudsNode', quality)
  }

  /**
   * Illuminance of level ground by the night sky, which lights clouds when sun and moon are down [lx].
   * By default that of `NightLightProbe`.
   */
  get nightIlluminance(): number {
    return this.field.night.illuminance
  }

  /** @throws If it is negative or not finite. */
  set nightIlluminance(illuminance: number) {
    checkNonNegative('CloudsNode', 'nightIlluminance', illuminance)
    this.field.night.illuminance = illuminance
  }

  /** Artistic factor on the light of sky and ground on clouds, finite, ≥ 0, default 1. Sun and moon stay as they are. */
  get ambient(): number {
    return this.field.ambient.value
  }

  /** @throws If it is negative or not finite. */
  set ambient(factor: number) {
    checkNonNegative('CloudsNode', 'ambient', factor)
    this.field.ambient.value = factor
  }

  /** Part of the light from behind that passes the clouds, in [0, 1]: a float per pixel of the screen, as last drawn. */
  get transmittance(): Node<'float'> {
    return this.passes.accumulated.light.sample(uv()).level(0).a
  }

  override updateBefore(frame: NodeFrame): undefined {
    const { camera, field, light } = this
    checkPrecipitation(field.layers, this.#precipitation)
    super.updateBefore(frame)
    const { renderer } = frame
    if (renderer === null) return
    this.#drawnBy = renderer
    const wasReady = this.isReady
    // Clouds that appear have no history.
    if (field.bake(renderer, this.#noiseSlices) && !wasReady) this.#frame.reset()
    // The light table is complete when clouds appear; later changes take a step a frame.
    light.update(this.isReady && !light.isReady ? Infinity : 1)
    // The passes below are drawn now, and read the view's uniforms.
    const view = this.view.update(frame)
    if (view === undefined) return
    const { width, height } = sizeOf(renderer)
    this.#uniforms.set(this.#quality)
    field.pixelAngle.value = 2 / (camera.projectionMatrix.elements[5] * height)
    field.depthScale.value = light.nodes.depthScale.value
    field.update(view, this.#time ?? frame.time)
    const version = light.texture.version + (this.#precipitation?.update(field, view) ?? 0)
    this.passes.setSize(width, height, this.#quality.block)
    this.#frame.next(camera, view, field, this.#quality.block, this.accumulates, version)
    if (this.#frame.hasNewWeather) this.shadows.forget()
    this.shadows.update(renderer, view, this.castsInto.size > 0)
    for (const screen of this.screens) screen.prepareShadows?.(renderer, view, frame)
    this.passes.render(renderer, view.up)
    this.#exposure.value = 1 / this.#frame.gain.value
    for (const screen of this.screens) screen.prepare?.(renderer, view, frame)
  }

  override update(frame: NodeFrame): undefined {
    super.update(frame)
    const view = this.view.update(frame)
    if (view === undefined) return
    for (const screen of this.screens) screen.update?.(view)
  }

  override customCacheKey(): number {
    return 8 * super.customCacheKey() + this.screens.size
  }

  override setup(builder: NodeBuilder): Node {
    return Fn(() => {
      const clouds = this.passes.accumulated.light.sample(uv()).level(0).toConst()
      const color = vec4(
        whereSeen(this.colorNode, clouds.a.greaterThan(0), builder) as Vec4
      ).toConst()
      const light = clouds.rgb.mul(this.#exposure)
      const result = color.rgb.mul(clouds.a).add(light).toVar()
      for (const screen of this.screens) result.assign(screen.dim(result, clouds.a))
      return vec4(result, color.a.mul(clouds.a).add(clouds.a.oneMinus()))
    })()
  }

  /** Frees its render targets and maps, and the noise and the light table if they are the node's own. */
  override dispose(): void {
    this.isDisposed = true
    // three compiles all materials again: those that had the clouds' shadows read freed textures.
    if (this.#drawnBy !== null) this.#drawnBy.contextNode.needsUpdate = true
    this.passes.dispose()
    this.shadows.dispose()
    this.field.dispose()
    if (this.#ownsLight) this.light.dispose()
    super.dispose()
  }
}

/** Volumetric clouds as a post effect: see {@link CloudsNode}. */
export const clouds = (
  color: Node,
  depth: Node,
  camera: Camera,
  atmosphere: Atmosphere,
  layers: CloudLayers,
  options?: CloudsOptions
): CloudsNode => new CloudsNode(color, depth, camera, atmosphere, layers, options)
