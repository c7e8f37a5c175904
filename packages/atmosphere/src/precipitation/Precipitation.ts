import {
  CustomBlending,
  DoubleSide,
  InstancedBufferGeometry,
  Float32BufferAttribute,
  Mesh,
  OneFactor,
  OneMinusSrcAlphaFactor
} from 'three'
import type { Camera, Light } from 'three'
import { Node, NodeMaterial, NodeUpdateType } from 'three/webgpu'
import type { NodeFrame } from 'three/webgpu'
import {
  checkFinite,
  checkNonNegative,
  checkOptions,
  checkPositive,
  fail,
  setOptions
} from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { checkRange } from '../check'
import type { Vec4 } from '../tsl-types'
import { DepthRays } from '../view/DepthRays'
import { checkAtmosphere } from '../view/ViewNodes'
import { FallingLattice, type PrecipitationWind } from './FallingLattice'
import { isLamp, LampUniforms } from './LampUniforms'
import { MeasuredLight } from './MeasuredLight'
import type { ParticleKind } from './ParticleKind'
import { PrecipitationShelter } from './PrecipitationShelter'
import { CHUNK, PrecipitationUniforms } from './PrecipitationUniforms'
import { particleFragment, particleVaryings } from './tsl/particleFragment'
import { particleVertex } from './tsl/particleVertex'

/** Options of {@link Precipitation}. */
export interface PrecipitationOptions {
  /** See {@link Precipitation.rate}; by default 5. */
  rate?: number
  /** See {@link Precipitation.wind}; by default none. */
  wind?: PrecipitationWind
  /** See {@link Precipitation.gusts}; by default 0.25. */
  gusts?: number
  /** See {@link Precipitation.shutter}; by default 1/120. */
  shutter?: number
  /** See {@link Precipitation.aperture}; by default 0.005. */
  aperture?: number
  /** See {@link Precipitation.focus}; by default 10. */
  focus?: number
  /** See {@link Precipitation.strength}; by default 1. */
  strength?: number
  /** See {@link Precipitation.time}; by default null. */
  time?: number | null
  /**
   * Lights of the scene that fall on it: sun, moon and other directional lights, probes and ambient lights, and up to four
   * `PointLight`s and `SpotLight`s. By default none.
   */
  lights?: readonly Light[]
  /** Roofs that keep it off; by default none. Shared, not owned. */
  shelter?: PrecipitationShelter
  /** Depth that hides it, of `depthCamera`, for a scene of its own that is laid over a picture; by default the depth test does. */
  depth?: Node
  /** Camera that drew `depth`. */
  depthCamera?: Camera
  /** Most particles of each of four classes of size, a positive integer; by default 131,072. */
  maxParticles?: number
}

const SETTINGS = [
  'rate',
  'wind',
  'gusts',
  'shutter',
  'aperture',
  'focus',
  'strength',
  'time'
] as const
const OTHERS = ['lights', 'shelter', 'depth', 'depthCamera', 'maxParticles'] as const

/** Most lamps. */
const LAMPS = 4
/** Diameter whose speed of fall is the mean that roofs are seen along [mm]. */
const MEAN_SPEED = { Rainfall: 6.5, Snowfall: 1 } as Record<string, number>

/** Chunk of quads: corners in [−1, 1]², and the quad's number. */
function chunkGeometry(): InstancedBufferGeometry {
  const geometry = new InstancedBufferGeometry()
  const corners: number[] = []
  const index: number[] = []
  for (let i = 0; i < CHUNK; i++) {
    corners.push(-1, -1, i, 1, -1, i, -1, 1, i, 1, 1, i)
    index.push(...[0, 1, 2, 2, 1, 3].map(n => 4 * i + n))
  }
  geometry.setAttribute('position', new Float32BufferAttribute(corners, 3))
  geometry.setIndex(index)
  return geometry
}

let made = 0

/** Falling particles as a material draws them: updates what their shaders read. */
class PrecipitationNode extends Node<'vec4'> {
  static get type(): string {
    return 'PrecipitationNode'
  }

  constructor(
    private readonly color: Vec4,
    private readonly before: (frame: NodeFrame) => void,
    private readonly during: (frame: NodeFrame) => void
  ) {
    super('vec4')
    this.updateBeforeType = NodeUpdateType.RENDER
    this.updateType = NodeUpdateType.RENDER
  }

  override updateBefore(frame: NodeFrame): undefined {
    this.before(frame)
  }

  override update(frame: NodeFrame): undefined {
    this.during(frame)
  }

  override setup(): Node {
    return this.color as unknown as Node
  }
}

/**
 * Rain or snow around the camera: streaks and flakes, as many as there are in real air.
 *
 * ```ts
 * const rain = rainfall(atmosphere, { rate: 12, wind: { east: 4, north: 0 }, lights: [sun, sky] })
 * scene.add(rain)
 * rain.rate = 25 // live; 0 draws nothing
 * ```
 *
 * Particles stand still against the planet but for their fall and the wind: a moving camera sees parallax. Each of four classes of size is drawn
 * as far as it can be seen, up to 16 m in rain and 24 m in snow; what falls farther off is haze, such as `heightFog` with
 * {@link Raindrops} or a cloud layer's precipitation. A particle's streak is its way against the camera while the shutter
 * is open, as opaque as the particle is on the mean, so that rain dims by π/4 ΣD² per length.
 *
 * The mesh is transparent, premultiplied, and writes no depth; it follows the camera by itself, wherever it stands in the scene, for perspective and
 * orthographic cameras and every kind of depth buffer. With `aerialPerspective` or clouds lay it over the picture by {@link precipitationOverlay}:
 * in the scene it would get the air of what is behind it. Lamps' shadow maps are not asked, and directional
 * light is that of four places in front of the camera.
 */
export class Precipitation extends Mesh<InstancedBufferGeometry, NodeMaterial> {
  /** Type tag: true. */
  readonly isPrecipitation = true
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  /** Shared, not owned. */
  readonly shelter: PrecipitationShelter | null
  readonly #kind: ParticleKind
  readonly #uniforms: PrecipitationUniforms
  readonly #lattice = new FallingLattice()
  readonly #measured: MeasuredLight
  readonly #lamps: readonly LampUniforms[]
  readonly #maxParticles: number
  #rate = 5
  #wind: PrecipitationWind = { east: 0, north: 0 }
  #gusts = 0.25
  #time: number | null = null

  /** @throws If an argument is of the wrong kind, or an option unknown or out of range. */
  constructor(atmosphere: Atmosphere, kind: ParticleKind, options: PrecipitationOptions = {}) {
    const where = kind.name
    checkAtmosphere(where, atmosphere)
    checkOptions(where, options, ...SETTINGS, ...OTHERS)
    const {
      lights = [],
      shelter = null,
      depth,
      depthCamera,
      maxParticles = 131_072,
      ...settings
    } = options
    checkLights(where, lights)
    if (shelter !== null && !(shelter instanceof PrecipitationShelter))
      fail(where, 'shelter must be a PrecipitationShelter', shelter)
    if (depth !== undefined && !depth?.isNode) fail(where, 'depth must be a node', depth)
    if (depth !== undefined && !depthCamera?.isCamera)
      fail(where, 'depthCamera must be the Camera that drew depth', depthCamera)
    if (!Number.isInteger(maxParticles) || maxParticles < 1)
      fail(where, 'maxParticles must be a positive integer', maxParticles)
    super(chunkGeometry(), new NodeMaterial())
    this.name = `Welkin.${where}`
    this.frustumCulled = false
    this.renderOrder = 2
    this.atmosphere = atmosphere
    this.shelter = shelter
    this.#kind = kind
    this.#maxParticles = maxParticles
    this.#uniforms = new PrecipitationUniforms(kind)
    this.#measured = new MeasuredLight(lights, kind.reach)
    this.#lamps = lights.filter(isLamp).map(lamp => new LampUniforms(lamp))
    this.shutter = 1 / 120
    this.aperture = 0.005
    this.focus = 10
    this.rate = 5
    this.set(settings)
    this.#makeMaterial(depth === undefined ? null : new DepthRays(depth, depthCamera!))
  }

  #makeMaterial(rays: DepthRays | null): void {
    const kind = this.#kind
    const uniforms = this.#uniforms
    const varyings = particleVaryings(`welkin${kind.name}${made++}`)
    const surroundings = { measured: this.#measured, lamps: this.#lamps, shelter: this.shelter }
    const color = particleFragment(kind, varyings, rays, uniforms.unit as never)
    const before = (frame: NodeFrame): void => this.#prepare(frame)
    const node = new PrecipitationNode(color, before, frame => this.#update(frame))
    Object.assign(this.material, {
      name: this.name,
      transparent: true,
      depthWrite: false,
      depthTest: rays === null,
      side: DoubleSide,
      fog: false,
      lights: false,
      blending: CustomBlending,
      blendSrc: OneFactor,
      blendSrcAlpha: OneFactor,
      blendDst: OneMinusSrcAlphaFactor,
      blendDstAlpha: OneMinusSrcAlphaFactor,
      // The colour is premultiplied already: three would do it again.
      premultipliedAlpha: false,
      vertexNode: particleVertex(kind, uniforms, varyings, surroundings),
      fragmentNode: node
    })
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or refused; then nothing has changed.
   */
  set(settings: Pick<PrecipitationOptions, (typeof SETTINGS)[number]>): this {
    return setOptions(this.#kind.name, this, settings, ...SETTINGS)
  }

  /** Rate of the rain or snow as water, in [0, 300] [mm/h]: drizzle has 0.5, a shower 10, a cloudburst 50; heavy snow 3. */
  get rate(): number {
    return this.#rate
  }

  set rate(value: number) {
    checkRange(this.#kind.name, 'rate', value, 0, 300)
    this.#rate = value
    // Three draws one instance where there are none to draw.
    this.geometry.instanceCount = this.#uniforms.setRate(value, this.#maxParticles)
  }

  /** Mean wind, `{ east, north }` [m/s]. */
  get wind(): PrecipitationWind {
    return this.#wind
  }

  set wind(value: PrecipitationWind) {
    const { name } = this.#kind
    checkOptions(`${name}.wind`, value, 'east', 'north')
    checkFinite(name, 'wind.east', value.east)
    checkFinite(name, 'wind.north', value.north)
    this.#wind = Object.freeze({ ...value })
  }

  /** Standard deviation of the wind's speed over its mean, in [0, 1] [–]. */
  get gusts(): number {
    return this.#gusts
  }

  set gusts(value: number) {
    checkRange(this.#kind.name, 'gusts', value, 0, 1)
    this.#gusts = value
  }

  /** Time for which the shutter is open, finite, ≥ 0 [s]. */
  get shutter(): number {
    return this.#uniforms.shutter.value
  }

  set shutter(value: number) {
    checkNonNegative(this.#kind.name, 'shutter', value)
    this.#uniforms.shutter.value = value
  }

  /** Diameter of the lens's opening, finite, ≥ 0 [m]: an eye has 0.005, a lens of 50 mm at f/2.8 0.018. */
  get aperture(): number {
    return this.#uniforms.aperture.value
  }

  set aperture(value: number) {
    checkNonNegative(this.#kind.name, 'aperture', value)
    this.#uniforms.aperture.value = value
  }

  /** Distance in focus, > 0 [m]. */
  get focus(): number {
    return this.#uniforms.focus.value
  }

  set focus(value: number) {
    checkPositive(this.#kind.name, 'focus', value)
    this.#uniforms.focus.value = value
  }

  /** Factor of opacity, finite, ≥ 0; 1 is physical [–]. */
  get strength(): number {
    return this.#uniforms.opacity.value
  }

  set strength(value: number) {
    checkNonNegative(this.#kind.name, 'strength', value)
    this.#uniforms.opacity.value = value
  }

  /** Time of fall, wind and gusts [s]; null follows the clock. */
  get time(): number | null {
    return this.#time
  }

  set time(value: number | null) {
    if (value !== null) checkFinite(this.#kind.name, 'time', value)
    this.#time = value
  }

  #follow({ camera, time }: NodeFrame): Camera | null {
    if (camera === null) return null
    const { atmosphere, wind, gusts } = this
    this.#lattice.update(atmosphere, camera, this.#time ?? time, wind, gusts)
    this.#measured.update(camera, this.#lattice)
    return camera
  }

  #prepare(frame: NodeFrame): void {
    const { renderer } = frame
    const camera = this.#follow(frame)
    if (renderer === null || camera === null) return
    this.#measured.render(renderer, camera)
    this.shelter?.render(renderer, camera, this.#lattice, MEAN_SPEED[this.#kind.name])
  }

  // Apart from `#prepare`, where a nested render (a mirror's) may still set another camera's values.
  #update(frame: NodeFrame): void {
    const camera = this.#follow(frame)
    if (camera === null) return
    this.#uniforms.setView(this.#lattice)
    this.shelter?.update(this.#lattice)
    for (const lamp of this.#lamps) lamp.update(camera)
  }

  /** Raycasts miss it. */
  override raycast(): void {}

  /** Frees geometry, material and what it measures light with; not its shelter. */
  override dispose(): void {
    this.geometry.dispose()
    this.material.dispose()
    this.#measured.dispose()
  }
}

/** @throws If they are no lights, or more lamps than four. */
function checkLights(where: string, lights: readonly Light[]): void {
  if (!Array.isArray(lights)) fail(where, 'lights must be an array of Lights', lights)
  lights.forEach((light: Light, i) => {
    if (!light?.isLight) fail(where, `lights[${i}] must be a Light`, light)
  })
  const lamps = lights.filter(isLamp).length
  if (lamps > LAMPS) fail(where, `lights must have at most ${LAMPS} lamps`, lamps)
}
