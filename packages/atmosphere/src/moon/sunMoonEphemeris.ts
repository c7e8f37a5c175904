import { Quaternion, Vector3 } from 'three'
import { eciToECEF, moonOrientation, moonPositionECEF, sunPositionECEF } from '@welkin/geo'

/**
 * Terms of the sun's longitude that `sunPositionECEF` leaves out: (A, B, C) of A cos(B + C τ), with A in
 * 1e-8 rad and τ in thousands of Julian years from J2000. They add up to 8″, which matters to an eclipse.
 *
 * @see Meeus, Astronomical Algorithms, 2nd ed., appendix III
 */
const SMALL_LONGITUDE_TERMS: readonly (readonly [number, number, number])[] = [
  [990, 5.233, 5884.927],
  [902, 2.045, 26.298],
  [857, 3.508, 398.149],
  [780, 1.179, 5223.694],
  [753, 2.533, 5507.553],
  [505, 4.583, 18849.228],
  [492, 4.205, 775.523],
  [357, 2.92, 0.067],
  [317, 5.849, 11790.629],
  [284, 1.899, 796.298],
  [271, 0.315, 10977.079],
  [243, 0.345, 5486.778],
  [206, 4.806, 2544.314],
  [205, 1.869, 5573.143],
  [202, 2.458, 6069.777],
  [156, 0.833, 213.299],
  [132, 3.411, 2942.463],
  [126, 1.083, 20.775],
  [115, 0.645, 0.98],
  [103, 0.636, 4694.003],
  [102, 0.976, 15720.839],
  [102, 4.267, 7.114],
  [99, 6.21, 2146.17],
  [98, 0.68, 155.42],
  [86, 5.98, 161000.69],
  [85, 1.3, 6275.96],
  [85, 3.67, 71430.7],
  [80, 1.81, 17260.15]
]

const J2000 = /*#__PURE__*/ Date.UTC(2000, 0, 1, 12)
const MILLISECONDS_PER_MILLENNIUM = 365_250 * 86_400_000

/** Position of the sun from the Earth's centre [m], refined by {@link SMALL_LONGITUDE_TERMS}. */
function refinedSunPositionECEF(date: Date, target: Vector3): Vector3 {
  const millennia = (date.getTime() - J2000) / MILLISECONDS_PER_MILLENNIUM
  const longitude = SMALL_LONGITUDE_TERMS.reduce(
    (sum, [a, b, c]) => sum + a * Math.cos(b + c * millennia),
    0
  )
  const obliquity = (23.44 * Math.PI) / 180
  const eclipticPole = new Vector3(0, -Math.sin(obliquity), Math.cos(obliquity))
  eclipticPole.transformDirection(eciToECEF(date))
  return sunPositionECEF(date, target).applyAxisAngle(eclipticPole, longitude * 1e-8)
}

/** Sun and moon at one moment, as the Earth's centre sees them; computed anew when the date changes. */
export class SunMoonEphemeris {
  #time = NaN
  /** Earth's centre to the sun [m]. */
  readonly sunECEF = new Vector3()
  /** Earth's centre to the moon [m]. */
  readonly moonECEF = new Vector3()
  /** Moon-fixed axes to ECEF. */
  readonly moonAxes = new Quaternion()

  at(date: Date): this {
    if (date.getTime() === this.#time) return this
    this.#time = date.getTime()
    refinedSunPositionECEF(date, this.sunECEF)
    moonPositionECEF(date, this.moonECEF)
    moonOrientation(date, this.moonAxes)
    return this
  }
}
