import type { Camera } from 'three'
import type { Renderer } from 'three/webgpu'
import {
  checkEllipsoid,
  checkOptions,
  checkPositive,
  Ellipsoid,
  fail,
  setOptions
} from '@welkin/geo'
import {
  AtmosphereParameters,
  checkParameters,
  type Spectrum
} from './parameters/AtmosphereParameters'
import { AtmosphereTables, checkTables } from './tables/AtmosphereTables'
import { AtmosphereView } from './view/AtmosphereView'
import { checkCamera } from './check'
import { LightSource } from './view/LightSource'
import { getOrMake } from './view/getOrMake'
import { checkLayer, type SkyLayer } from './view/SkyLayer'
import { checkRenderer } from './view/renderers'
import { ScenePlanet, type AtmosphereFrame } from './ScenePlanet'
import { SphericalSpace } from './view/cpu/spherical'

/** Options of {@link Atmosphere}. */
export interface AtmosphereOptions {
  /** Composition of the air; by default the Earth's. Shared, not copied. */
  parameters?: AtmosphereParameters
  /**
   * Tables of another atmosphere of the same air, to share: `other.tables`. `parameters`, `luminanceScale`
   * and `bakeStepsPerFrame` are then those of both.
   */
  tables?: AtmosphereTables
  /** The planet's figure; by default that of the parameters. */
  ellipsoid?: Ellipsoid
  /** See {@link Atmosphere.flat}; by default false. */
  flat?: boolean
  /** See {@link Atmosphere.frame}; by default `'local'`. */
  frame?: AtmosphereFrame
  /** See {@link Atmosphere.metersPerUnit}; by default 1. */
  metersPerUnit?: number
  /** See {@link Atmosphere.luminanceScale}; by default 1e-4. */
  luminanceScale?: number
  /** See {@link Atmosphere.bakeStepsPerFrame}; by default infinity. */
  bakeStepsPerFrame?: number
  /** See {@link Atmosphere.date}; by default null. */
  date?: Date | null
}

/** Options that may change later. */
const SETTINGS = [
  'flat',
  'frame',
  'metersPerUnit',
  'luminanceScale',
  'bakeStepsPerFrame',
  'date'
] as const

const FULL: Spectrum = [1, 1, 1, 1]

/** The parameters' own figure, WGS84 where they are of the Earth's size, or a sphere. */
function ellipsoidOf({ bottomRadius, ellipsoid }: AtmosphereParameters): Ellipsoid {
  if (ellipsoid !== null) return ellipsoid
  return isNear(bottomRadius, Ellipsoid.WGS84) ? Ellipsoid.WGS84 : new Ellipsoid(bottomRadius)
}

const isNear = (radius: number, { radii }: Ellipsoid): boolean =>
  Math.abs(radius / radii.x - 1) <= 0.02

/**
 * A planet's air, sun and place: what every node and light of this package is made from.
 *
 * ```ts
 * const atmosphere = new Atmosphere()
 * atmosphere.place({ longitude: 139.77, latitude: 35.68 })
 * atmosphere.date = new Date('2026-06-21T09:30:00Z')
 * ```
 *
 * Out of the box it suits a plain three scene: metres, Y up, X east, Z south, origin at sea level at
 * longitude and latitude 0, sun 45° high in the south-east. Tables are computed on the GPU when a
 * node that uses them is first rendered, and again when `parameters` change.
 */
export class Atmosphere extends ScenePlanet {
  /** Type tag: true. */
  readonly isAtmosphere = true
  /** Composition of the air. Change it with `parameters.set(…)`. */
  readonly parameters: AtmosphereParameters
  /** Tables on the GPU, its own or shared; the last atmosphere or shell that is disposed of frees them. */
  readonly tables: AtmosphereTables
  /** The sun as a source of light; its `irradiance` dims in an eclipse. */
  readonly sun = new LightSource(target => target.copy(this.sunDirection))
  readonly #layers: SkyLayer[] = []
  #layersVersion = 0
  readonly #views = new WeakMap<LightSource, WeakMap<Camera, AtmosphereView>>()
  readonly #space = new SphericalSpace()

  /** @throws If an option is of the wrong kind. */
  constructor(options: AtmosphereOptions = {}) {
    checkOptions('Atmosphere', options, 'parameters', 'tables', 'ellipsoid', ...SETTINGS)
    const { parameters = options.tables?.parameters ?? new AtmosphereParameters() } = options
    checkParameters('Atmosphere', parameters)
    const {
      parameters: _,
      tables = new AtmosphereTables(parameters),
      ellipsoid = ellipsoidOf(parameters),
      ...settings
    } = options
    checkTables('Atmosphere', tables, parameters)
    checkEllipsoid('Atmosphere', ellipsoid)
    const { bottomRadius } = parameters
    if (!isNear(bottomRadius, ellipsoid)) {
      fail('Atmosphere', 'bottomRadius must be near that of the ellipsoid', bottomRadius)
    }
    super(ellipsoid)
    this.parameters = parameters
    this.tables = tables
    tables.addSource(this)
    this.set(settings)
    this.sun.irradianceAt = position =>
      this.#layers.reduce<Spectrum>((light, layer) => {
        const left = layer.eclipse?.(position)
        return left ? (light.map((value, i) => value * left[i]) as unknown as Spectrum) : light
      }, FULL)
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or refused; then nothing has changed.
   */
  set(settings: Pick<AtmosphereOptions, (typeof SETTINGS)[number]>): this {
    return setOptions('Atmosphere', this, settings, ...SETTINGS)
  }

  /** Output of every node per luminance, > 0 [1/(cd/m²)]. */
  get luminanceScale(): number {
    return this.tables.luminanceScale
  }

  set luminanceScale(value: number) {
    checkPositive('Atmosphere', 'luminanceScale', value)
    this.tables.luminanceScale = value
  }

  /**
   * Most steps of baking tables in one frame, ≥ 1; a bake has 20. The default, infinity, bakes at once.
   * Until the first bake is done the sky is black. After a change sunlight follows at once, the sky when
   * its table is ready; a bake that is under way is finished before the next one starts.
   */
  get bakeStepsPerFrame(): number {
    return this.tables.bakeStepsPerFrame
  }

  set bakeStepsPerFrame(value: number) {
    if (value !== Infinity && !(Number.isInteger(value) && value >= 1)) {
      fail('Atmosphere', 'bakeStepsPerFrame must be a positive integer or Infinity', value)
    }
    this.tables.bakeStepsPerFrame = value
  }

  /** World space to the space in which the planet is a sphere, as it is now. */
  get space(): SphericalSpace {
    this.#space.flat = this.flat
    this.#space.set(this.worldToECEF, this.ellipsoid, this.parameters.bottomRadius)
    return this.#space
  }

  /**
   * Bakes stale tables and computes the sky volume for a camera. Nodes call it as they are rendered;
   * call it yourself to choose when the work is done.
   *
   * @param camera - Camera, whose `matrixWorld` must be up to date.
   * @param source - Source of the light.
   */
  update(renderer: Renderer, camera: Camera, source: LightSource = this.sun): AtmosphereView {
    // Its room was left to others if it was disposed of.
    this.tables.addSource(this)
    this.tables.update(renderer, this)
    checkCamera('Atmosphere.update', camera)
    const views = getOrMake(this.#views, source, () => new WeakMap())
    const view = getOrMake(views, camera, () => new AtmosphereView(this, camera, source))
    view.update(renderer)
    return view
  }

  /** A camera's view as {@link update} last left it. */
  viewOf(camera: Camera, source: LightSource = this.sun): AtmosphereView | undefined {
    return this.#views.get(source)?.get(camera)
  }

  /** Layers of the sky besides air and sun, from far to near. */
  get layers(): readonly SkyLayer[] {
    return this.#layers
  }

  /** Grows whenever {@link layers} change. */
  get layersVersion(): number {
    return this.#layersVersion
  }

  /**
   * Shows something more in the sky: moon, stars, airglow. Add what is far before what is near.
   *
   * Background and fog show it from the next frame on, after compiling their shaders anew. A
   * `RenderPipeline` that has rendered does so when its `needsUpdate` is set to true, and a node of
   * yours around background or fog when its own is.
   *
   * @returns This atmosphere.
   * @throws If something is no layer, another atmosphere's, or there already; then nothing is added.
   */
  add(...layers: SkyLayer[]): this {
    for (const layer of layers) {
      checkLayer('Atmosphere.add', layer)
    }
    const all = [...this.#layers, ...layers]
    const twice = all.find((layer, i) => all.indexOf(layer) < i)
    if (twice) fail('Atmosphere.add', 'layer is in the sky already', twice)
    for (const layer of layers) layer.attach?.(this)
    this.#layers.push(...layers)
    this.#layersVersion++
    return this
  }

  /**
   * Takes layers out of the sky, as {@link add} puts them in; what is not in it is passed over. It frees
   * no memory: that is for a layer's `dispose`.
   *
   * @returns This atmosphere.
   */
  remove(...layers: SkyLayer[]): this {
    for (const layer of layers) {
      const index = this.#layers.indexOf(layer)
      if (index < 0) continue
      this.#layers.splice(index, 1)
      this.#layersVersion++
    }
    return this
  }

  /**
   * Bakes all tables now and reads back what `skyIlluminanceAt` and `skyLuminanceAt` need.
   *
   * @param renderer - Renderer, which is initialised first if it is not yet.
   */
  async bake(renderer: Renderer): Promise<void> {
    checkRenderer('Atmosphere', renderer)
    await renderer.init()
    this.tables.update(renderer, this, Infinity)
    await this.tables.read()
  }

  /**
   * Frees all GPU memory, but for tables that others share. The atmosphere and its layers can be used
   * again, from nothing.
   */
  dispose(): void {
    this.tables.release(this)
    // Out for now: a moon that is disposed removes itself.
    const layers = this.#layers.splice(0)
    for (const layer of layers) layer.dispose?.()
    this.#layers.push(...layers)
    this.dispatchEvent({ type: 'dispose' })
  }
}
