import { EventDispatcher, MathUtils, Matrix4, Vector3 } from 'three'
import type { Camera } from 'three'
import type { Renderer } from 'three/webgpu'
import {
  checkBoolean,
  checkChoice,
  checkDirection,
  checkEllipsoid,
  checkOptions,
  checkPlace,
  checkPositive,
  Ellipsoid,
  fail,
  Geodetic,
  setOptions,
  sunDirectionECEF
} from '@welkin/geo'
import type { GeodeticLike } from '@welkin/geo'
import {
  AtmosphereParameters,
  checkParameters,
  type Spectrum
} from './parameters/AtmosphereParameters'
import { AtmosphereTables } from './tables/AtmosphereTables'
import { AtmosphereView } from './view/AtmosphereView'
import { checkCamera, checkRange } from './check'
import { LightSource } from './view/LightSource'
import { checkLayer, type SkyLayer } from './view/SkyLayer'
import { AtmosphereQuery } from './AtmosphereQuery'
import { SphericalSpace } from './view/cpu/spherical'
import type { Triple } from './air/cpu/color'

/** Options of {@link Atmosphere}. */
export interface AtmosphereOptions {
  /** Composition of the air; by default the Earth's. Shared, not copied. */
  parameters?: AtmosphereParameters
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

/** Lie of the scene's world space on the planet. */
export type AtmosphereFrame = 'local' | 'ecef'

const FULL: Spectrum = [1, 1, 1, 1]

/** The parameters' own figure, WGS84 where they are of the Earth's size, or a sphere. */
function ellipsoidOf(parameters: AtmosphereParameters): Ellipsoid {
  checkParameters('Atmosphere', parameters)
  const { bottomRadius, ellipsoid } = parameters
  if (ellipsoid !== null) return ellipsoid
  return isNear(bottomRadius, Ellipsoid.WGS84) ? Ellipsoid.WGS84 : new Ellipsoid(bottomRadius)
}

const isNear = (radius: number, { radii }: Ellipsoid): boolean =>
  Math.abs(radius / radii.x - 1) <= 0.02

const _position = new Vector3()
const _rotation = new Matrix4()

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
export class Atmosphere extends EventDispatcher<{ dispose: object }> {
  /** For type testing. */
  readonly isAtmosphere = true
  /** Composition of the air. Change it with `parameters.set(…)`. */
  readonly parameters: AtmosphereParameters
  /** The planet's figure. */
  readonly ellipsoid: Ellipsoid
  /**
   * World units to metres in ECEF. {@link place} and {@link frame} set it; set it yourself for any
   * other frame, such as the inverse of a tile set's `group.matrixWorld`. It must keep angles.
   */
  readonly worldToECEF = new Matrix4()
  #luminanceScale = 1e-4
  #bakeStepsPerFrame = Infinity
  #metersPerUnit = 1
  #frame: AtmosphereFrame = 'local'
  readonly #place = new Geodetic()
  #date: Date | null = null
  readonly #sunECEF = new Vector3()
  readonly #sunWorld = new Vector3(1, Math.SQRT2, 1).normalize()
  /** Tables on the GPU. */
  readonly tables = new AtmosphereTables()
  /** The sun as a source of light; its `irradiance` dims in an eclipse. */
  readonly sun = new LightSource(target => target.copy(this.sunDirection), this.tables.volumes)
  readonly #layers: SkyLayer[] = []
  #layersVersion = 0
  readonly #views = new WeakMap<LightSource, WeakMap<Camera, AtmosphereView>>()
  readonly #space = new SphericalSpace()

  /** @throws If an option is of the wrong kind. */
  constructor(options: AtmosphereOptions = {}) {
    super()
    if (options instanceof AtmosphereParameters) {
      fail('Atmosphere', 'options must be an object: write new Atmosphere({ parameters })', options)
    }
    const {
      parameters = new AtmosphereParameters(),
      ellipsoid = ellipsoidOf(parameters),
      ...settings
    } = checkOptions('Atmosphere', options, 'parameters', 'ellipsoid', ...SETTINGS)
    checkParameters('Atmosphere', parameters)
    checkEllipsoid('Atmosphere', ellipsoid)
    const { bottomRadius } = parameters
    if (!isNear(bottomRadius, ellipsoid)) {
      fail('Atmosphere', 'bottomRadius must be near that of the ellipsoid', bottomRadius)
    }
    this.parameters = parameters
    this.ellipsoid = ellipsoid
    this.set(settings)
    this.sun.irradianceAt = position =>
      this.#layers.reduce<Spectrum>((light, layer) => {
        const left = layer.eclipse?.(position)
        return left ? (light.map((value, i) => value * left[i]) as unknown as Spectrum) : light
      }, FULL)
    this.#updateFrame()
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or refused; then nothing has changed.
   */
  set(settings: Pick<AtmosphereOptions, (typeof SETTINGS)[number]>): this {
    return setOptions('Atmosphere', this, settings, ...SETTINGS)
  }

  /**
   * Flat world: up is +Y wherever the camera goes, and height is y. For scenes with no
   * planet, however far they reach.
   *
   * It looks just as it does at the origin of a round world, the horizon's dip and the reddening of a
   * low sun included. What the camera sees is hazed and lit as if the ground fell away from it with the
   * planet's curve: over 10 km by 8 m and 0.1° of the sun's height.
   */
  get flat(): boolean {
    return this.#space.flat
  }

  set flat(value: boolean) {
    checkBoolean('Atmosphere', 'flat', value)
    if (value && this.#frame === 'ecef') {
      fail('Atmosphere', "flat must be false in the frame 'ecef'", value)
    }
    this.#space.flat = value
  }

  /** Output of every node per luminance, > 0 [1/(cd/m²)]. */
  get luminanceScale(): number {
    return this.#luminanceScale
  }

  set luminanceScale(value: number) {
    checkPositive('Atmosphere', 'luminanceScale', value)
    this.#luminanceScale = value
  }

  /**
   * Most steps of baking tables in one frame, ≥ 1; a bake has 20. The default, infinity, bakes at once.
   * Until the first bake is done the sky is black. After a change sunlight follows at once, the sky when
   * its table is ready; a bake that is under way is finished before the next one starts.
   */
  get bakeStepsPerFrame(): number {
    return this.#bakeStepsPerFrame
  }

  set bakeStepsPerFrame(value: number) {
    if (value !== Infinity && !(Number.isInteger(value) && value >= 1)) {
      fail('Atmosphere', 'bakeStepsPerFrame must be a positive integer or Infinity', value)
    }
    this.#bakeStepsPerFrame = value
  }

  /**
   * Puts the world's origin at a place, Y up, X east, Z south.
   *
   * @param geodetic - Longitude, latitude [°], height above the ellipsoid [m], default 0.
   * @throws If a coordinate is missing, not finite or out of range.
   */
  place(geodetic: GeodeticLike): this {
    checkPlace('Atmosphere.place', 'geodetic', geodetic)
    this.#place.copy(geodetic)
    this.#frame = 'local'
    this.#updateFrame()
    return this
  }

  /** `'local'`: as {@link place} says. `'ecef'`: world axes are ECEF's. */
  get frame(): AtmosphereFrame {
    return this.#frame
  }

  set frame(value: AtmosphereFrame) {
    checkChoice('Atmosphere', 'frame', value, ['local', 'ecef'])
    if (value === 'ecef' && this.flat) {
      fail('Atmosphere', "frame must be 'local' where the world is flat", value)
    }
    this.#frame = value
    this.#updateFrame()
  }

  /** Metres in a world unit, > 0. Setting it resets {@link worldToECEF} to the frame's. */
  get metersPerUnit(): number {
    return this.#metersPerUnit
  }

  set metersPerUnit(value: number) {
    checkPositive('Atmosphere', 'metersPerUnit', value)
    this.#metersPerUnit = value
    this.#updateFrame()
  }

  #updateFrame(): void {
    const unit = this.#metersPerUnit
    if (this.#frame === 'ecef') {
      this.worldToECEF.makeScale(unit, unit, unit)
      return
    }
    this.ellipsoid.geodeticToECEF(this.#place, _position)
    this.ellipsoid.localYUpFrame(_position, this.worldToECEF)
    this.worldToECEF.scale(_position.setScalar(unit))
  }

  /** Date that sun, moon and stars follow; a copy. Null if the sun's direction was set by hand. */
  get date(): Date | null {
    return this.#date && new Date(this.#date)
  }

  set date(value: Date | null) {
    if (value !== null && !(value instanceof Date && Number.isFinite(value.getTime()))) {
      fail('Atmosphere', 'date must be a valid Date or null', value)
    }
    if (value === null) this.#sunWorld.copy(this.sunDirection)
    else sunDirectionECEF(value, this.#sunECEF)
    this.#date = value && new Date(value)
  }

  /**
   * Direction to the sun in world space, unit length; a copy. Setting it stops following the date.
   */
  get sunDirection(): Vector3 {
    if (this.#date === null) return this.#sunWorld.clone()
    _rotation.copy(this.worldToECEF).invert()
    return this.#sunECEF.clone().transformDirection(_rotation)
  }

  set sunDirection(world: Vector3) {
    checkDirection('Atmosphere', 'sunDirection', world)
    this.#sunWorld.copy(world).normalize()
    this.#date = null
  }

  /**
   * Points the sun by angles, for scenes without a date: from where {@link worldToECEF} puts the
   * world's origin or, if that is deep inside the planet as in ECEF, from the {@link place}.
   *
   * @param elevation - Above the horizon, in [−90, 90] [°].
   * @param azimuth - From north, clockwise [°]. North is −Z of a local frame.
   */
  setSunAngles(elevation: number, azimuth: number): this {
    checkRange('Atmosphere.setSunAngles', 'elevation', elevation, -90, 90)
    if (!Number.isFinite(azimuth))
      fail('Atmosphere.setSunAngles', 'azimuth must be finite', azimuth)
    const origin = _position.setFromMatrixPosition(this.worldToECEF)
    if (origin.length() < this.ellipsoid.radii.x / 2) {
      this.ellipsoid.geodeticToECEF(this.#place, origin)
    }
    this.ellipsoid.localYUpFrame(origin, _rotation)
    const north = MathUtils.degToRad(180 - azimuth)
    const fromZenith = MathUtils.degToRad(90 - elevation)
    this.sunDirection = new Vector3()
      .setFromSphericalCoords(1, fromZenith, north)
      .transformDirection(_rotation)
      .transformDirection(_rotation.copy(this.worldToECEF).invert())
    return this
  }

  /** World space to the space in which the planet is a sphere, as it is now. */
  get space(): SphericalSpace {
    this.#space.set(this.worldToECEF, this.ellipsoid, this.parameters.bottomRadius)
    return this.#space
  }

  /**
   * Bakes stale tables and computes the sky volume for a camera. Nodes call it as they are rendered;
   * call it yourself to choose when the work is done.
   *
   * @param camera - Its `matrixWorld` must be up to date.
   * @param source - Whose light it is.
   */
  update(renderer: Renderer, camera: Camera, source: LightSource = this.sun): AtmosphereView {
    this.tables.update(renderer, this.parameters, this.luminanceScale, this.bakeStepsPerFrame)
    let views = this.#views.get(source)
    if (views === undefined) this.#views.set(source, (views = new WeakMap()))
    let view = views.get(camera)
    if (view === undefined) {
      checkCamera('Atmosphere.update', camera)
      views.set(camera, (view = new AtmosphereView(this, camera, source)))
    }
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
    if (twice) fail('Atmosphere.add', 'layer must not be in the sky already', twice)
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
   * Bakes all tables now and reads back what {@link skyIlluminanceAt} and `skyLuminanceAt` need.
   *
   * @param renderer - Initialised.
   */
  async bake(renderer: Renderer): Promise<void> {
    this.tables.update(renderer, this.parameters, this.luminanceScale, Infinity)
    await this.tables.read()
  }

  /**
   * Answers questions about light, as things are now.
   *
   * @param position - World: where light is asked about; by default the origin.
   * @param source - Whose light.
   */
  query(position = new Vector3(), source: LightSource = this.sun): AtmosphereQuery {
    const { parameters, space, tables } = this
    const direction = source.direction(new Vector3(), position)
    const irradiance = source.irradianceAt(position)
    return new AtmosphereQuery(parameters, space, direction, tables.data, irradiance)
  }

  /**
   * Illuminance by the sun on a plane that faces it, reddened by the air and blocked by the planet.
   *
   * @param position - World.
   * @returns Linear sRGB [lx].
   */
  sunIlluminanceAt(position: Vector3): Triple {
    return this.query(position).sunIlluminance(position)
  }

  /**
   * Illuminance by sky and ground on a plane.
   *
   * @param position - World.
   * @param normal - World, unit length: where the plane faces.
   * @returns Linear sRGB [lx].
   * @throws Before the tables were baked and read back: await {@link bake} first.
   */
  skyIlluminanceAt(position: Vector3, normal: Vector3): Triple {
    return this.query(position).skyIlluminance(position, normal)
  }

  /** Frees all GPU memory. The atmosphere and its layers can be used again, from nothing. */
  dispose(): void {
    this.tables.dispose()
    // Out for now: a moon that is disposed removes itself.
    const layers = this.#layers.splice(0)
    for (const layer of layers) layer.dispose?.()
    this.#layers.push(...layers)
    this.dispatchEvent({ type: 'dispose' })
  }
}
