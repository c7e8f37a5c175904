import type { Matrix3 } from 'three'
import { Matrix4 } from 'three'
import { eciToECEF } from '@welkin/geo'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { Mat3, Vec3 } from '../tsl-types'
import { matrix3 } from '../uniforms'

const _matrix = new Matrix4()
const _scale = new Matrix4()

/** Rotation of view directions into the stars' frame: mean equator and equinox of J2000. */
export class CelestialFrame {
  /**
   * Rotation from the stars' frame to ECEF; null follows the atmosphere's date. Without a date the two
   * frames are one.
   */
  orientation: Matrix4 | null = null
  readonly #mappedToAxes = matrix3()
  readonly #rotation = new Matrix4()
  #time = NaN

  /** @param axes - Rotation from the stars' frame to other axes, if those are wanted. */
  constructor(readonly axes: Matrix3 | null = null) {}

  /** Follows the date. */
  update({ atmosphere }: AtmosphereView): void {
    const { date, ellipsoid } = atmosphere
    if (this.orientation !== null) {
      _matrix.copy(this.orientation)
    } else if (date !== null) {
      if (date.getTime() !== this.#time) eciToECEF(date, this.#rotation)
      this.#time = date.getTime()
      _matrix.copy(this.#rotation)
    } else {
      _matrix.identity()
    }
    // The mapped space is ECEF times 1/radii; the inverse of a rotation is its transpose.
    const { x, y, z } = ellipsoid.radii
    _matrix.transpose().multiply(_scale.makeScale(1, y / x, z / x))
    this.#mappedToAxes.value.setFromMatrix4(_matrix)
    if (this.axes !== null) this.#mappedToAxes.value.premultiply(this.axes)
  }

  /** Direction in the stars' frame (or {@link axes}), of about the same length. */
  fromMapped(directionMapped: Vec3): Vec3 {
    return (this.#mappedToAxes as unknown as Mat3).mul(directionMapped)
  }
}
