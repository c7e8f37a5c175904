import { Matrix4, Vector3, type Camera } from 'three'
import type { Atmosphere } from '../Atmosphere'
import { BOX_SIDE } from './cpu/drawnParticles'
import { gustiness } from './cpu/gustiness'

/** Time after which flakes flutter as before [s]: each turns a whole number of times in it. */
export const LOOP_TIME = 512
/** Distance from the anchor after which a new one is taken [m]. */
const ANCHOR_REACH = 10_000
/** Fastest camera whose speed draws streaks; what is faster is a cut [m/s]. */
const FASTEST = 400

/** Wind at the camera [m/s]. */
export interface PrecipitationWind {
  /** Speed towards the east [m/s]. */
  readonly east: number
  /** Speed towards the north [m/s]. */
  readonly north: number
}

interface CameraTrack {
  readonly position: Vector3
  readonly velocity: Vector3
  time: number
}

const _ecef = new Vector3()
const _matrix = new Matrix4()

/**
 * Frame in which particles fall, and how far they have drifted, in float64.
 *
 * Its axes are those of a place on the planet near the camera: Y up, X east, Z south [m]. It stays there while the camera moves and
 * while the world's origin does, so that particles do.
 */
export class FallingLattice {
  /** Displacements in the frame [m] to view space [world units]: the upper 3 × 3. */
  readonly toView = new Matrix4()
  /** Velocity of the air [m/s], gusts included, and of the camera [m/s]. */
  readonly wind = new Vector3()
  readonly cameraVelocity = new Vector3()
  /** Position of the camera [m]. */
  readonly camera = new Vector3()
  /** Direction that the camera looks in. */
  readonly forward = new Vector3()
  /** Metres to world units. */
  unit = 1
  /** Time of fall [s], and since the loop's begin, in [0, 1). */
  time = 0
  phase = 0
  readonly #drift = new Vector3()
  readonly #frame = new Matrix4()
  readonly #fromECEF = new Matrix4()
  #anchored: Atmosphere['ellipsoid'] | null = null
  #time: number | null = null
  readonly #tracks = new WeakMap<Camera, CameraTrack>()

  /**
   * Advances air and camera.
   *
   * @param time - Time of the fall [s].
   * @param gusts - Standard deviation of the wind's speed over its mean [–].
   */
  update(
    atmosphere: Atmosphere,
    camera: Camera,
    time: number,
    { east, north }: PrecipitationWind,
    gusts: number
  ): void {
    const now = gustiness(time)
    const before = gustiness(this.#time ?? time)
    const way = time - (this.#time ?? time) + gusts * (now.way - before.way)
    this.#drift.x += east * way
    this.#drift.z -= north * way
    this.#time = this.time = time
    this.phase = time / LOOP_TIME - Math.floor(time / LOOP_TIME)
    this.wind.set(east, 0, -north).multiplyScalar(Math.max(1 + gusts * now.speed, 0))

    this.#anchor(atmosphere, camera)
    const { worldToECEF } = atmosphere
    this.camera.setFromMatrixPosition(camera.matrixWorld).applyMatrix4(worldToECEF)
    this.camera.applyMatrix4(this.#fromECEF)
    this.unit = 1 / worldToECEF.getMaxScaleOnAxis()
    this.toView.copy(worldToECEF).invert().multiply(this.#frame)
    this.toView.premultiply(_matrix.copy(camera.matrixWorld).invert())
    this.forward.set(0, 0, -1).transformDirection(_matrix.copy(this.toView).invert())
    this.#track(camera, time)
  }

  #anchor({ worldToECEF, ellipsoid, flat }: Atmosphere, camera: Camera): void {
    _ecef.setFromMatrixPosition(flat ? worldToECEF : camera.matrixWorld)
    if (!flat) _ecef.applyMatrix4(worldToECEF)
    const at = this.camera.setFromMatrixPosition(this.#frame)
    if (this.#anchored === ellipsoid && at.distanceTo(_ecef) < ANCHOR_REACH) return
    this.#anchored = ellipsoid
    ellipsoid.localYUpFrame(_ecef, this.#frame)
    this.#fromECEF.copy(this.#frame).invert()
  }

  #track(camera: Camera, time: number): void {
    const track = this.#tracks.get(camera)
    if (track === undefined) {
      const position = this.camera.clone()
      this.#tracks.set(camera, { position, velocity: new Vector3(), time })
      this.cameraVelocity.setScalar(0)
      return
    }
    const seconds = time - track.time
    if (seconds !== 0) {
      track.velocity.copy(this.camera).sub(track.position).divideScalar(seconds)
      if (!(seconds > 0 && track.velocity.length() < FASTEST)) track.velocity.setScalar(0)
      track.time = time
      track.position.copy(this.camera)
    }
    this.cameraVelocity.copy(track.velocity)
  }

  /**
   * Box of a class.
   *
   * @param reach - Distance up to which it is drawn [m].
   * @param middle - Its middle from the camera [m].
   * @param drift - Offset of its particles over its side, in [0, 1).
   */
  box(reach: number, middle: Vector3, drift: Vector3): void {
    // The middle of the sphere around a sector of ±47°, the diagonal of a picture of 55° by 16:9.
    middle.copy(this.forward).multiplyScalar(0.73 * reach)
    drift
      .copy(this.#drift)
      .sub(this.camera)
      .sub(middle)
      .divideScalar(BOX_SIDE * reach)
    for (const axis of ['x', 'y', 'z'] as const) drift[axis] += 0.5 - Math.floor(drift[axis] + 0.5)
  }
}
