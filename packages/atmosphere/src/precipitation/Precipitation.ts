import { CustomBlending, DoubleSide, Mesh, OneFactor, OneMinusSrcAlphaFactor } from 'three'
import type { Camera, InstancedBufferGeometry } from 'three'
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
import { chunkGeometry } from './chunkGeometry'
import { FallingChunks } from './FallingChunks'
import { isLamp, LampUniforms } from './LampUniforms'
import { MeasuredLight } from './MeasuredLight'
import type { ParticleKind } from './ParticleKind'
import { checkLights, OTHERS, SETTINGS, type PrecipitationOptions } from './PrecipitationOptions'
import { PrecipitationShelter } from './PrecipitationShelter'
import { PrecipitationUniforms } from './PrecipitationUniforms'
import { particleFragment, particleVaryings } from './tsl/particleFragment'
import { particleVertex } from './tsl/particleVertex'

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
    return this.color
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
 * as far as it can be seen, up to 16 m in rain and 18 m in snow; what falls farther off is haze, such as `heightFog` with
 * {@link Raindrops} or a cloud layer's precipitation. A particle's streak is its path relative to the camera while the shutter is open, as
 * opaque as the particle is on average, so that rain dims by π/4 ΣD² per length.
 *
 * The mesh is transparent, premultiplied, and writes no depth; it follows the camera by itself, wherever it stands in the scene, for perspective and
 * orthographic cameras and every kind of depth buffer. With `aerialPerspective` or clouds lay it over the picture by {@link precipitationOverlay}:
 * in the scene it would get the air of what is behind it. Lamps' shadow maps are not sampled, and directional light is that of four places
 * in front of the camera.
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
  readonly #chunks: FallingChunks
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
      maxParticles = kind.most,
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
    const chunks = new FallingChunks(kind, maxParticles)
    super(chunkGeometry(chunks.attribute), new NodeMaterial())
    this.name = `Welkin.${where}`
    this.frustumCulled = false
    this.renderOrder = 2
    this.atmosphere = atmosphere
    this.shelter = shelter
    this.#kind = kind
    this.#chunks = chunks
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
    const color = particleFragment(kind, varyings, rays, uniforms.unit)
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
    this.#uniforms.setRate(value, this.#chunks.setRate(value))
    this.material.visible = value > 0
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
    const { wind, cameraVelocity } = this.#lattice
    // Streaks, flutter and discs out of focus reach out of their chunks.
    const speed = wind.distanceTo(cameraVelocity) + 10
    const margin = speed * this.shutter + this.aperture + 0.1
    this.geometry.instanceCount = this.#chunks.update(this.#lattice, camera, margin)
    this.#measured.render(renderer, camera)
    this.shelter?.render(renderer, camera, this.#lattice, this.#kind.meanSpeed)
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
