import { tableTarget } from '@welkin/atmosphere'
import type { AtmosphereView, LightSource, SharedRows } from '@welkin/atmosphere'
import { Quaternion, Vector3 } from 'three'
import type { RenderTarget, Vector4 } from 'three'
import { texture } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { viewpointMapped, type CloudField } from '../density/CloudField'
import { PassByKinds } from '../density/kinds'
import {
  CASCADE_SIZE as SIZE,
  CascadeState,
  HALF_WIDTHS,
  LIGHT_JUMP,
  lightTolerance,
  PLACE_JUMP,
  STALE_DRIFT,
  STALE_LIGHT,
  STALE_PLACE,
  TABLE_COLUMNS
} from './CascadeState'
import type { CascadeNodes, CloudShadows } from './tsl/sampleShadows'
import type { ShadingFall } from './tsl/fallDepth'
import { shadowRay, type ShadowRayUniforms } from './tsl/shadowRay'
import type { LevelTexture, Vec2 } from '../tsl-types'
import { number, vector2, vector3, vector4 } from '../uniforms'

/**
 * Height of the camera above which cascades double in width with each doubling of it [m]. Greater: shadows
 * end within the picture (*Shadows*).
 */
const WIDENING_HEIGHT = 6000

/**
 * Highest camera for which clouds and surfaces read maps [m]: from farther away, clouds are a thin skin without shadows of
 * their own (*World clouds*).
 */
const HIGHEST = 150_000

/** Highest camera for which air reads maps [m], and their most widening: the widest cascade then ends at its horizon. */
const HIGHEST_IN_AIR = 2_000_000
const MOST_WIDENING = 64

/**
 * Cosine of the angle about the planet's centre after which the plane's origin follows the camera: 32 km on
 * the Earth.
 */
const ANCHOR_COSINE = Math.cos(0.005)

/**
 * Frames over which a cascade is drawn anew, a strip in each. More: frames take less long, shadows follow
 * later (*Shadows*).
 */
const STRIPS = 4

/**
 * Rows below the cascades for what each light's shafts keep there: for a picture of 1920×1080 498, for one of 4 to 3 660. Fewer: coarser shafts
 * in materials.
 */
const ROOM_ROWS = 664

interface Cascade {
  readonly nodes: CascadeNodes
  isDrawn: boolean
  state: CascadeState
}

const _below = new Vector3()
const _offset = new Vector3()
const _drift = new Vector3()
const _rotation = new Quaternion()

/**
 * Beer shadow maps of clouds: optical depth towards the light, the sun by day and the moon by night, in three
 * cascades about the camera.
 *
 * A texel is a ray of light. It is named by where it crosses a plane among the clouds, level unless the light
 * is low, so that texels are spread over the ground whatever the light's height. Each cascade's middle
 * moves by whole texels. A cascade drifts with the clouds, and is drawn anew, a strip a frame, when it no
 * longer fits them: a sky that stands still costs nothing.
 */
export class CloudShadowMap {
  readonly field: CloudField
  readonly target: RenderTarget
  readonly nodes: CloudShadows
  readonly #cascades: readonly Cascade[]
  /** Cascade that is drawn anew, its next strip, and the state that it gets when it is done. */
  #current: Cascade | null = null
  #strip = 0
  #spare: CascadeState
  readonly #ray: ShadowRayUniforms
  readonly #pass: PassByKinds
  /** Viewpoint at the last update, from the planet's centre in the mapped space [m]. */
  readonly camera = new Vector3()
  readonly #anchor = new Vector3()
  readonly #light = new Vector3()
  /** Source of the light that the maps are of. */
  source: LightSource
  #inputs: readonly unknown[] = []
  #order = 0
  /** False from so far away that neither clouds nor surfaces read maps. */
  #isNear = true
  /** Rooms below the cascades. */
  readonly #rooms: { target: SharedRows['target'] }[] = []
  /** Rooms that were left, to be had by the next instead of one more. */
  readonly left: SharedRows[] = []
  /** Index of the thickest layer, with which maps drift. */
  #thickest = 0

  /** @param falling - Rain and snow, which shade too; updated before the maps. */
  constructor(
    field: CloudField,
    readonly falling?: ShadingFall
  ) {
    this.field = field
    this.source = field.atmosphere.sun
    const width = SIZE * (HALF_WIDTHS.length + 1) + TABLE_COLUMNS
    this.target = tableTarget('Welkin.CloudShadows', width, SIZE)
    this.#cascades = HALF_WIDTHS.map((_, i) => ({
      nodes: {
        u: vector4(),
        v: vector4(),
        w: vector4(),
        isDrawn: number(),
        isCast: number(),
        atlasTile: number()
      },
      isDrawn: false,
      state: new CascadeState(i, field.rotations)
    }))
    this.#spare = new CascadeState(HALF_WIDTHS.length, field.rotations)
    this.nodes = {
      map: texture(this.target.texture) as unknown as LevelTexture<Vec2>,
      cascades: this.#cascades.map(cascade => cascade.nodes),
      scale: vector2(),
      isMoonlit: number()
    }
    this.nodes.scale.value.set(SIZE / width, 1)
    this.#ray = {
      toLight: vector3(),
      origin: vector3(),
      across: vector3(),
      along: vector3(),
      halfWidth: number(),
      size: SIZE
    }
    const draw = (compiled: CloudField) => shadowRay(compiled, this.#ray, falling)
    this.#pass = new PassByKinds('Welkin.CloudShadows', field, draw)
  }

  /** True if there are maps for clouds and surfaces: not before the first update, and not far away. */
  get isDrawn(): boolean {
    return this.#isNear && this.#cascades[0].isDrawn
  }

  /**
   * Draws what no longer fits: a strip, or all cascades at once after a jump. The field must be up to
   * date.
   *
   * @param view - View of the field's camera, up to date.
   * @param castsIntoAir - True if air reads the maps, too: then they are there from space.
   */
  update(renderer: Renderer, view: AtmosphereView, castsIntoAir = false): void {
    const radius = this.field.radius.value
    viewpointMapped(view, this.camera)
    const { night, atmosphere } = this.field
    const isMoonlit = night.isMoonlitAt(view)
    this.source = isMoonlit && night.source !== null ? night.source : atmosphere.sun
    this.nodes.isMoonlit.value = isMoonlit ? 1 : 0
    this.#light.copy(isMoonlit ? night.moonDirection.value : view.lightDirection)
    this.#isNear = view.height <= HIGHEST
    if (view.height > (castsIntoAir ? HIGHEST_IN_AIR : HIGHEST)) {
      this.forget()
    } else {
      this.#draw(renderer, view, radius)
    }
    this.#updateNodes()
  }

  #draw(renderer: Renderer, view: AtmosphereView, radius: number): void {
    const { layers, isReady, fadeIn, worldMap } = this.field
    const parameters = [...layers].map(layer => layer.parameters)
    const map = [worldMap?.texture.version, worldMap?.bounds]
    this.#inputs = [isReady, radius, fadeIn, ...map, ...parameters]
    _below.copy(view.up).multiplyScalar(radius + this.#middle())
    if (!(_below.dot(this.#anchor) > ANCHOR_COSINE * _below.length() * this.#anchor.length())) {
      this.#anchor.copy(_below)
    }
    const widening = 2 ** Math.ceil(Math.log2(Math.max(view.height / WIDENING_HEIGHT, 1)))
    const scale = Math.min(widening, MOST_WIDENING)
    let oldest = this.#current
    for (const [index, cascade] of this.#cascades.entries()) {
      const halfWidth = HALF_WIDTHS[index] * scale
      const { state } = cascade
      if (!cascade.isDrawn || !this.#fits(state, halfWidth)) {
        if (cascade === this.#current) this.#current = null
        if (cascade === oldest) oldest = null
        this.#move(state, halfWidth)
        this.#render(renderer, state, 0, SIZE)
        cascade.isDrawn = true
      } else if (this.#current === null && this.#isStale(state)) {
        if (oldest === null || state.order < oldest.state.order) oldest = cascade
      }
    }
    if (oldest === null) return
    if (this.#current === null) {
      this.#current = oldest
      this.#strip = 0
      this.#move(this.#spare, oldest.state.halfWidth)
    }
    const rows = SIZE / STRIPS
    this.#render(renderer, this.#spare, this.#strip * rows, rows)
    if (++this.#strip < STRIPS) return
    const { state } = oldest
    oldest.state = this.#spare
    this.#spare = state
    this.#current = null
  }

  /** Draws some rows of a cascade. */
  #render(renderer: Renderer, state: CascadeState, from: number, rows: number): void {
    this.#setRay(state)
    const { viewport, scissor } = this.target
    viewport.set(state.atlasTile * SIZE, 0, SIZE, SIZE)
    scissor.set(state.atlasTile * SIZE, from, SIZE, rows)
    this.target.scissorTest = true
    this.#pass.render(renderer, this.target)
  }

  /** An altitude in the middle of the thickest clouds [m]. */
  #middle(): number {
    let [middle, most] = [0, 0]
    for (const [index, { parameters }] of [...this.field.layers].entries()) {
      const { baseAltitude, topAltitude, coverage, density } = parameters
      const depth = coverage === 0 ? 0 : density * (topAltitude - baseAltitude)
      if (depth <= most) continue
      ;[middle, most] = [0.6 * baseAltitude + 0.4 * topAltitude, depth]
      this.#thickest = index
    }
    return middle
  }

  /** Displacement of a layer by the wind, where the camera is, since a cascade was drawn [m]. */
  #driftOf({ rotations }: CascadeState, target: Vector3, layer = this.#thickest): Vector3 {
    _rotation.copy(rotations[layer]).invert().multiply(this.field.rotations[layer])
    return target.copy(_below).applyQuaternion(_rotation).sub(_below).negate()
  }

  /** Distance of the camera from a cascade's middle, the greater of those along its axes [m]. */
  #distance(state: CascadeState): number {
    const { anchor, across, measure, center } = state
    this.#driftOf(state, _drift)
    _offset.copy(_below).sub(anchor).sub(_drift)
    const u = across.dot(_offset) - center.u
    const v = measure.dot(_offset) - center.v
    return Math.max(Math.abs(u), Math.abs(v))
  }

  /** True if a cascade may be read until it is drawn anew: it is about the camera still, and in nearly the same light. */
  #fits(state: CascadeState, halfWidth: number): boolean {
    return (
      state.halfWidth === halfWidth &&
      // Drawn before the noise was ready, it has no clouds.
      state.inputs[0] === this.#inputs[0] &&
      state.light.distanceTo(this.#light) < LIGHT_JUMP * lightTolerance(state) &&
      this.#distance(state) < PLACE_JUMP * halfWidth
    )
  }

  #isStale(state: CascadeState): boolean {
    const { inputs, light, texel } = state
    const distance = this.#distance(state)
    return (
      distance > STALE_PLACE * texel ||
      light.distanceTo(this.#light) > STALE_LIGHT * lightTolerance(state) ||
      this.#inputs.some((value, i) => value !== inputs[i]) ||
      [...this.field.layers].some(
        ({ parameters }, i) =>
          parameters.coverage > 0 &&
          this.#driftOf(state, _offset, i).distanceTo(_drift) > STALE_DRIFT * texel
      )
    )
  }

  #move(state: CascadeState, halfWidth: number): void {
    state.moveTo(this.#light, this.#anchor, _below, halfWidth, this.field.rotations)
    state.inputs = this.#inputs
    state.order = this.#order++
  }

  #setRay(state: CascadeState): void {
    const { light, anchor, across, along, center, halfWidth } = state
    const ray = this.#ray
    ray.toLight.value.copy(light)
    ray.origin.value
      .copy(anchor)
      .add(this.#driftOf(state, _drift))
      .sub(this.camera)
      .addScaledVector(across, center.u)
      .addScaledVector(along, center.v)
    ray.across.value.copy(across).multiplyScalar(2 * halfWidth)
    ray.along.value.copy(along).multiplyScalar(2 * halfWidth)
    ray.halfWidth.value = halfWidth
  }

  /** Sets the uniforms of look-ups, for the camera and the clouds where they are now. */
  #updateNodes(): void {
    for (const { nodes, isDrawn, state } of this.#cascades) {
      nodes.isCast.value = isDrawn ? 1 : 0
      nodes.isDrawn.value = isDrawn && this.#isNear ? 1 : 0
      if (!isDrawn) continue
      const { atlasTile, halfWidth, anchor, across, measure, normal, center } = state
      nodes.atlasTile.value = atlasTile
      _offset.copy(this.camera).sub(anchor).sub(this.#driftOf(state, _drift))
      const row = (target: Vector4, axis: Vector3, shift: number, width: number): void => {
        target.set(axis.x, axis.y, axis.z, axis.dot(_offset) + shift).divideScalar(width)
      }
      row(nodes.u.value, across, halfWidth - center.u, 2 * halfWidth)
      row(nodes.v.value, measure, halfWidth - center.v, 2 * halfWidth)
      row(nodes.w.value, normal, 0, halfWidth)
    }
  }

  /**
   * Makes room below the cascades, for 1,056 columns of what is drawn there in each frame. Where the map grows by that, cascades are drawn anew
   * in the next update.
   */
  makeRoom(): SharedRows {
    const { target } = this
    const room = { target, first: target.height, count: ROOM_ROWS }
    this.#rooms.push(room)
    target.setSize(target.width, room.first + ROOM_ROWS)
    this.nodes.scale.value.y = SIZE / target.height
    this.forget()
    this.#updateNodes()
    return room
  }

  /** Has all cascades drawn anew in the next update. */
  forget(): void {
    for (const cascade of this.#cascades) cascade.isDrawn = false
    this.#current = null
  }

  /** Frees the map. */
  dispose(): void {
    for (const room of this.#rooms) room.target = undefined
    this.target.dispose()
    this.#pass.dispose()
  }
}
