import { e_tilt, MakeTime } from 'astronomy-engine'
import { Vector3 } from 'three'
import { checkDate } from './check'
import { siderealAngle } from './earthRotation'

type Term = readonly [amplitude: number, phase: number, frequency: number]

const astronomicalUnit = 149597870700

/**
 * The Earth around the sun: the leading terms of VSOP87D (ecliptic and equinox of date), A cos(B + C τ)
 * with τ in thousands of Julian years from J2000. Longitude in radians, distance in astronomical units.
 *
 * astronomy-engine has the long series, but its tables of every planet come with it (17 kB gzipped).
 *
 * @see Bretagnon & Francou 1988; Meeus, Astronomical Algorithms, 2nd ed., appendix III.
 */
const longitudeTerms: readonly (readonly Term[])[] = [
  [
    [1.75347046, 0, 0],
    [0.03341656, 4.6692568, 6283.07585],
    [0.00034894, 4.6261, 12566.1517],
    [0.00003497, 2.7441, 5753.3849],
    [0.00003418, 2.8289, 3.5231],
    [0.00003136, 3.6277, 77713.7715],
    [0.00002676, 4.4181, 7860.4194],
    [0.00002343, 6.1352, 3930.2097],
    [0.00001324, 0.7425, 11506.7698],
    [0.00001273, 2.0371, 529.691],
    [0.00001199, 1.1096, 1577.3435]
  ],
  [
    [6283.31966747, 0, 0],
    [0.00206059, 2.678235, 6283.07585],
    [0.00004303, 2.6351, 12566.1517]
  ],
  [
    [0.00052919, 0, 0],
    [0.0000872, 1.0721, 6283.0758]
  ]
]

const distanceTerms: readonly (readonly Term[])[] = [
  [
    [1.00013989, 0, 0],
    [0.016707, 3.0984635, 6283.07585],
    [0.00013956, 3.05525, 12566.1517],
    [0.00003084, 5.1985, 77713.7715],
    [0.00001628, 1.1739, 5753.3849],
    [0.00001576, 2.8469, 7860.4194]
  ],
  [[0.00103019, 1.10749, 6283.07585]]
]

/** Aberration of the sun at 1 au [rad]. */
const aberration = ((20.4898 / 3600) * Math.PI) / 180

/**
 * Apparent position of the sun's centre from the Earth's centre, aberration and nutation included.
 *
 * Within 12″ of the full theory from 1800 to 2200, and 15″ more in longitude because UT1 is taken
 * equal to UTC.
 *
 * @param date - Instant, UTC.
 * @returns ECEF [m].
 * @throws Error if the date is invalid.
 * @see Meeus, Astronomical Algorithms, 2nd ed., chapter 25.
 */
export function sunPositionECEF(date: Date, target: Vector3 = new Vector3()): Vector3 {
  checkDate('sunPositionECEF', date)
  return computeSunPosition(date, target)
}

/**
 * Unit direction from the Earth's centre to the sun; from its surface the sun is within 9″ of it.
 *
 * @param date - Instant, UTC.
 * @returns ECEF.
 * @throws Error if the date is invalid.
 * @see sunPositionECEF
 */
export function sunDirectionECEF(date: Date, target: Vector3 = new Vector3()): Vector3 {
  checkDate('sunDirectionECEF', date)
  return computeSunPosition(date, target).normalize()
}

function computeSunPosition(date: Date, target: Vector3): Vector3 {
  const time = MakeTime(date)
  const millennia = time.tt / 365250
  const { dpsi, tobl } = e_tilt(time)
  const nutation = ((dpsi / 3600) * Math.PI) / 180
  const obliquity = (tobl * Math.PI) / 180

  const distance = series(distanceTerms, millennia)
  const longitude = series(longitudeTerms, millennia) + Math.PI + nutation - aberration / distance
  // The sun's ecliptic latitude stays below 1.2″ and is left out.
  const x = Math.cos(longitude)
  const y = Math.sin(longitude) * Math.cos(obliquity)
  const z = Math.sin(longitude) * Math.sin(obliquity)

  const angle = siderealAngle(date)
  const c = Math.cos(angle)
  const s = Math.sin(angle)
  return target.set(c * x + s * y, c * y - s * x, z).multiplyScalar(distance * astronomicalUnit)
}

function series(powers: readonly (readonly Term[])[], millennia: number): number {
  let sum = 0
  let power = 1
  for (const terms of powers) {
    for (const [amplitude, phase, frequency] of terms) {
      sum += power * amplitude * Math.cos(phase + frequency * millennia)
    }
    power *= millennia
  }
  return sum
}
