import { Matrix4, Vector3, Vector4 } from 'three'
import type { PerspectiveCamera } from 'three'
import type { AtmosphereView } from '@welkin/atmosphere'
import { viewpointMapped, type CloudField } from '../density/CloudField'
import { CloudLayers } from '../layers/CloudLayers'
import { LAYER_STRIDE } from '../layers/layerUniforms'
import { nightGain } from '../light/NightLight'
import { vec4Array } from '../tsl-types'
import { matrix3, matrix4, number, vector2 } from '../uniforms'

/** Order in which the pixels of a block are marched: neighbours in time are far apart. */
const ORDERS: Readonly<Record<number, readonly number[]>> = {
  1: [0],
  2: [0, 3, 1, 2],
  3: [4, 0, 8, 2, 6, 1, 7, 3, 5],
  4: [0, 10, 2, 8, 5, 15, 7, 13, 1, 11, 3, 9, 4, 14, 6, 12]
}

/** Mean distance of consecutive noise is the greatest for multiples of this. */
const GOLDEN_RATIO = (Math.sqrt(5) - 1) / 2

/** Frames whose light a pixel remembers while the view or the clouds move. */
const MOVING_FRAMES = 24

/** Looks that a pixel remembers even then. */
const MOVING_LOOKS = 4

/** Looks after which nothing is left of the light before a change: (3/4)¹² is 3 %. */
const FORGETTING_LOOKS = 12

/** Looks that a pixel remembers in a picture that stands still. */
const STILL_LOOKS = 256

/** How far history may be from its surroundings, in standard deviations. */
const MOVING_CLIPPING = 1.25
const STILL_CLIPPING = 8

/** A move of the camera within a frame after which it is somewhere else: in heights, and at least [m]. */
const CUT_HEIGHTS = 0.3
const CUT_METRES = 300

/** A move of the clouds within a frame after which they are others [m]. */
const CLOUD_CUT = 500

/** Factor of the gain within a frame after which light is another. */
const LIGHT_CUT = 4

const isSame = (values: readonly number[], before: readonly number[]): boolean =>
  values.every((value, i) => Math.abs(value - before[i]) <= 1e-9 * Math.abs(value))

/** Below or above a layer by less, an eye is among its clouds [m]. */
const NEARBY = 200

const isAmongClouds = (height: number, { layers }: CloudField): boolean =>
  [...layers].some(
    ({ parameters: { baseAltitude, topAltitude } }) =>
      height > baseAltitude - NEARBY && height < topAltitude + NEARBY
  )

const _toPrevious = new Matrix4()
const _delta = new Vector3()
const _position = new Vector3()
const _origin = new Vector4()

/** What changes from frame to frame: sizes, jitter, and where the last frame's pixels were. */
export class FrameUniforms {
  /** Of the picture [pixels]. */
  readonly size = vector2()
  /** Of what is marched in a frame [pixels]. */
  readonly marchedSize = vector2()
  /** Pixels of the picture along an edge of the blocks of which a frame marches one. */
  readonly block = number(1)
  /** Which one [pixels]. */
  readonly jitter = vector2()
  /** Shifts the noise of steps, in [0, 1). */
  readonly noiseShift = number()
  readonly projectionInverse = matrix4()
  readonly near = number()
  readonly far = number()
  /** From (x, y, 1) of a pixel in normalized device coordinates to a ray through it, in view space. */
  readonly rays = matrix3()
  /** From such a place to where in clip space (x, y, w) of the last frame its ray led. */
  readonly raysBefore = matrix3()
  /** Where there, in that space, the eye would have been from which each layer has stayed where it is. */
  readonly origins: Vector4[] = Array.from({ length: CloudLayers.maxLayers }, () => new Vector4())
  readonly originArray = vec4Array(this.origins)
  /** 0 where there is no last frame. */
  readonly hasHistory = number()
  /** Most looks that a pixel remembers. */
  readonly memory = number(1)
  readonly clipping = number(1)
  /** 1 for an eye among the clouds, which looks for clear air in tiles first; else 0. */
  readonly isAmong = number()
  /** Stored light per light, and what light of the last frame has to be multiplied with. */
  readonly gain = number(1)
  readonly gainChange = number(1)
  #count = 0
  #camera: Vector3 | null = null
  readonly #sun = new Vector3()
  readonly #projection = new Matrix4()
  /** Displacements in the mapped space to view space of the last frame. */
  readonly #fromMapped = new Matrix4()
  /** What light and clouds are made from, and how the camera looks. */
  #matter: number[] = []
  #aim: number[] = []
  /** Frames until pixels have forgotten what was before the last change of light or clouds. */
  #forgetting = 0

  /** Has the next frame start anew. */
  reset(): void {
    this.#camera = null
  }

  /**
   * Goes on to the next frame. Field and view must be up to date.
   *
   * @param usesHistory - Whether frames are accumulated.
   * @param lightVersion - Changes with what light clouds scatter.
   */
  next(
    camera: PerspectiveCamera,
    view: AtmosphereView,
    field: CloudField,
    block: number,
    usesHistory: boolean,
    lightVersion = 0
  ): void {
    const order = ORDERS[block]
    const index = order[this.#count % order.length]
    this.jitter.value.set(index % block, Math.floor(index / block))
    if (this.block.value !== block) this.reset()
    this.block.value = block
    // Of each pixel's looks, which are whole rounds apart; and of the pixels of a block.
    const round = Math.floor(this.#count / order.length)
    const shift = round * GOLDEN_RATIO + index / order.length
    this.noiseShift.value = usesHistory ? shift % 1 : 0
    this.#count++
    this.projectionInverse.value.copy(camera.projectionMatrixInverse)
    this.isAmong.value = isAmongClouds(view.height, field) ? 1 : 0
    this.near.value = camera.near
    this.far.value = camera.far
    const gain = nightGain(view, field.radius.value)
    this.gainChange.value = gain / this.gain.value
    this.gain.value = gain

    viewpointMapped(view, _position)
    const last = this.#camera
    const reach = Math.max(CUT_HEIGHTS * Math.abs(view.height), CUT_METRES)
    const isCut =
      !usesHistory ||
      !(last !== null && last.distanceTo(_position) < reach) ||
      Math.abs(Math.log(this.gainChange.value)) > Math.log(LIGHT_CUT) ||
      field.drifts.some(drift => !(drift.length() < CLOUD_CUT))
    this.hasHistory.value = isCut ? 0 : 1
    let isStill = !isCut
    const { elements: e } = camera.projectionMatrixInverse
    // Two places on a ray are two depths: any between near and far gives its direction.
    const [x, y, z] = [0, 1, 2].map(row => 0.5 * e[8 + row] + e[12 + row])
    const rays = this.rays.value.set(e[0], e[4], x, e[1], e[5], y, e[2], e[6], z)
    if (last !== null) {
      _delta.copy(_position).sub(last)
      _toPrevious
        .makeTranslation(_delta)
        .premultiply(this.#fromMapped)
        .premultiply(this.#projection)
      const { elements: p } = _toPrevious
      this.raysBefore.value
        .set(p[0], p[4], p[8], p[1], p[5], p[9], p[3], p[7], p[11])
        .multiply(view.viewToMapped)
        .multiply(rays)
      isStill &&= _delta.lengthSq() < 1e-12
    }
    field.drifts.forEach((drift, i) => {
      const { x, y, z, w } = _origin.set(-drift.x, -drift.y, -drift.z, 1).applyMatrix4(_toPrevious)
      this.origins[i].set(x, y, w, z)
      isStill &&= drift.lengthSq() === 0
    })
    const { direction, irradiance, radiance } = field.night
    const matter = [
      ...field.values.filter((_, i) => i % LAYER_STRIDE < 3),
      ...[direction, irradiance, radiance].map(({ value }) => value)
    ].flatMap(vector => vector.toArray())
    matter.push(lightVersion)
    const isSunStill = this.#sun.distanceToSquared(view.sunDirection) < 1e-12
    if (isCut) this.#forgetting = 0
    else if (isSunStill && isSame(matter, this.#matter)) this.#forgetting--
    else this.#forgetting = FORGETTING_LOOKS * order.length
    const aim = [...view.viewToMapped.elements, ...camera.projectionMatrix.elements]
    isStill &&= this.#forgetting <= 0 && isSame(aim, this.#aim)
    this.memory.value = isStill ? STILL_LOOKS : Math.max(MOVING_FRAMES / order.length, MOVING_LOOKS)
    this.clipping.value = isStill ? STILL_CLIPPING : MOVING_CLIPPING

    this.#matter = matter
    this.#aim = aim
    this.#sun.copy(view.sunDirection)
    this.#projection.copy(camera.projectionMatrix)
    this.#fromMapped.setFromMatrix3(view.viewToMapped).invert()
    this.#camera = (last ?? new Vector3()).copy(_position)
  }
}
