import { checkPlace } from './check'

/** A place by longitude [degrees], latitude [degrees] and height [m]; `height` is 0 if left out. */
export interface GeodeticLike {
  /** East of the prime meridian, any finite value [degrees]. */
  readonly longitude: number
  /** Geodetic, positive to the north, in [−90, 90] [degrees]. */
  readonly latitude: number
  /** Above the ellipsoid, default 0 [m]. */
  readonly height?: number
}

/**
 * A place on or above an ellipsoid, in geodetic coordinates.
 *
 * ```ts
 * const tokyo = new Geodetic(139.77, 35.68, 40)
 * const positionECEF = Ellipsoid.WGS84.geodeticToECEF(tokyo)
 * ```
 */
export class Geodetic implements GeodeticLike {
  /** East of the prime meridian [degrees]. Functions return (−180, 180] and accept any finite value. */
  longitude!: number
  /** Angle from the equator to the ellipsoid's normal, positive to the north, in [−90, 90] [degrees]. */
  latitude!: number
  /** Along the ellipsoid's normal, negative inside [m]. */
  height!: number

  /**
   * @param longitude - [degrees], any finite value.
   * @param latitude - [degrees], in [−90, 90].
   * @param height - Above the ellipsoid [m].
   * @throws Error if a value is not finite or the latitude is out of range.
   */
  constructor(longitude = 0, latitude = 0, height = 0) {
    this.take('Geodetic', { longitude, latitude, height })
  }

  /** Sets all three values; the same ranges and errors as the constructor. */
  set(longitude: number, latitude: number, height = 0): this {
    return this.take('Geodetic.set', { longitude, latitude, height })
  }

  /** Copies another place; the same ranges and errors as the constructor. */
  copy(place: GeodeticLike): this {
    return this.take('Geodetic.copy', place)
  }

  private take(where: string, place: GeodeticLike): this {
    checkPlace(where, 'place', place)
    this.longitude = place.longitude
    this.latitude = place.latitude
    this.height = place.height ?? 0
    return this
  }

  clone(): Geodetic {
    return new Geodetic(this.longitude, this.latitude, this.height)
  }
}
