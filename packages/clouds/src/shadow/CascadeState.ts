import type { Quaternion } from 'three'
import { Vector3 } from 'three'
import { CASCADE_RATIO } from './tsl/shadowRay'

/** Texels along an edge of a cascade. */
export const CASCADE_SIZE = 256

/** Columns beside the cascades, for a table of what shadows do to diffuse light: `DiffuseRatioTable` [texels]. */
export const TABLE_COLUMNS = 32

/**
 * Sine of the least angle between rays of light and the plane that the map lies in. Smaller: coarse shadows
 * at dusk (*Cirrus*).
 */
const LEAST_SLOPE = 0.2

/**
 * Half widths of the cascades for a camera near the ground [m]. Greater: blurred shadows near by; smaller:
 * they end nearer (*Shadows*).
 */
export const HALF_WIDTHS = [0, 1, 2].map(i => 5000 * CASCADE_RATIO ** i)

/**
 * Change of the light's direction [rad], times that of `lightTolerance`, or of the place in half widths, for which a cascade
 * is drawn at once. Greater: shadows follow a jump late (*Shadows*).
 */
export const LIGHT_JUMP = 0.01
export const PLACE_JUMP = 0.5

/**
 * Changes for which a cascade is drawn anew: moves of its middle [texels], moves of layers against each
 * other [texels], and of the light's direction [rad], which move the shadow of a cloud 3 km away by a third of a texel of the
 * narrowest cascade. Greater: shadows jump instead of drifting (*Shadows*, which has "Time lapse"); smaller: they are drawn in
 * every frame.
 */
export const STALE_PLACE = 8
export const STALE_DRIFT = 0.25
export const STALE_LIGHT = 4.8e-3

/**
 * Most that a wider cascade tolerates of the light's direction, over the narrowest one. Greater: depths along low light,
 * which change with its direction, are late.
 */
const MOST_TOLERANCE = 4

/** Change of the light's direction that a cascade tolerates over the narrowest one: as much as its texels are wider. */
export const lightTolerance = ({ halfWidth }: CascadeState): number =>
  Math.min(halfWidth / HALF_WIDTHS[0], MOST_TOLERANCE)

const _normal = new Vector3()
const _offset = new Vector3()

/** A cascade as it was drawn: in the planet's mapped space, which neither camera nor origin move. */
export class CascadeState {
  /** Index of its tile in the map. */
  readonly atlasTile: number
  halfWidth = 0
  readonly anchor = new Vector3()
  readonly light = new Vector3()
  /** The plane's normal over its cosine to the light. */
  readonly normal = new Vector3()
  readonly across = new Vector3()
  /** Vector whose dot product with a point is the coordinate along the second axis of where its ray of light meets the plane. */
  readonly measure = new Vector3()
  readonly along = new Vector3()
  /** Coordinates of the middle [m]. */
  readonly center = { u: 0, v: 0 }
  /** Rotations of the layers' noise by the wind. */
  readonly rotations: readonly Quaternion[]
  /** Other inputs of its drawing, such as layers' parameters: it is stale when one changes. */
  inputs: readonly unknown[] = []
  /** Count of drawings: the cascade with the least was drawn longest ago. */
  order = 0

  constructor(atlasTile: number, rotations: readonly Quaternion[]) {
    this.atlasTile = atlasTile
    this.rotations = rotations.map(rotation => rotation.clone())
  }

  /** Width of a texel [m]. */
  get texel(): number {
    return (2 * this.halfWidth) / CASCADE_SIZE
  }

  /**
   * Moves the cascade: its middle to the texel nearest to a point. All in the mapped space, from the planet's centre.
   *
   * @param light - Direction to the light.
   * @param anchor - The plane's origin [m].
   * @param wanted - Point nearest to which the middle is put [m].
   * @param halfWidth - Half width of the cascade [m].
   * @param rotations - Rotations of the layers' noise by the wind.
   */
  moveTo(
    light: Vector3,
    anchor: Vector3,
    wanted: Vector3,
    halfWidth: number,
    rotations: readonly Quaternion[]
  ): void {
    const { across, along, measure, normal, center } = this
    this.light.copy(light)
    this.anchor.copy(anchor)
    this.halfWidth = halfWidth
    this.rotations.forEach((rotation, i) => rotation.copy(rotations[i]))
    // The plane is level, but tilted towards a low light.
    _normal.copy(anchor).normalize()
    across.crossVectors(light, _normal)
    if (across.lengthSq() < 1e-12) across.set(_normal.z, _normal.x, _normal.y).cross(_normal)
    across.normalize()
    const slope = light.dot(_normal)
    if (Math.abs(slope) < LEAST_SLOPE) {
      const level = along.copy(light).addScaledVector(_normal, -slope).normalize()
      // n = up sin a + level cos a with n·s = LEAST_SLOPE, to the light's side of the plane.
      const sign = slope < 0 ? -1 : 1
      const lean = Math.asin(LEAST_SLOPE) - Math.asin(Math.abs(slope))
      _normal.multiplyScalar(Math.cos(lean)).addScaledVector(level, sign * Math.sin(lean))
    }
    along.crossVectors(_normal, across)
    normal.copy(_normal).divideScalar(_normal.dot(light))
    measure.copy(along).addScaledVector(normal, -along.dot(light))
    _offset.copy(wanted).sub(anchor)
    const { texel } = this
    center.u = Math.round(across.dot(_offset) / texel) * texel
    center.v = Math.round(measure.dot(_offset) / texel) * texel
  }
}
