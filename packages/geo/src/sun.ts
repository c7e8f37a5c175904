import { Vector3 } from 'three'
import { checkDate } from './check'

type Term = readonly [amplitude: number, phase: number, frequency: number]

const astronomicalUnit = 149597870700

/**
 * The Earth around the sun: the leading terms of VSOP87D (ecliptic and equinox of date), A cos(B + C τ)
 * with τ in thousands of Julian years from J2000. Longitude in radians, distance in astronomical units.
 *
 * astronomy-engine has the long series, but its tables of every planet come with it (17 kB gzipped), and
 * even its sidereal time and nutation alone make 2 kB. What an atmosphere needs of the sun is here.
 *
 * @see Meeus, Astronomical Algorithms, 2nd ed., appendix III, after Bretagnon & Francou 1988.
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
 * Within 13″ of the full theory from 1800 to 2200, and 15″ more in longitude because UT1 is taken
 * equal to UTC.
 *
 * @param date - Instant, UTC.
 * @returns ECEF [m].
 * @throws Error if the date is invalid.
 * @see Meeus, Astronomical Algorithms, 2nd ed., chapters 12, 22 and 25.
 */
export function sunPositionECEF(date: Date, target: Vector3 = new Vector3()): Vector3 {
  checkDate('sunPositionECEF', date)
  const distance = series(distanceTerms, terrestrialMillennia(date))
  return direction(date, distance, target).multiplyScalar(distance * astronomicalUnit)
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
  // The true distance turns it by 0.3″ at most.
  return direction(date, 1, target)
}

const radians = (degrees: number): number => (degrees * Math.PI) / 180

/**
 * ΔT = TT − UT in the long run [s]. Within 50 s from 1800 to 2100, in which the sun moves 2″.
 *
 * @see Espenak & Meeus 2006, "Five millennium canon of solar eclipses", "Polynomial expressions for ΔT", after
 *   Morrison & Stephenson 2004, J. Hist. Astron. 35, 327.
 */
const terrestrialLag = (centuries: number): number => -20 + 32 * (centuries + 1.8) ** 2

/** Days from J2000, UT. */
const universalDays = (date: Date): number => date.getTime() / 86_400_000 - 10_957.5

/** Thousands of Julian years from J2000, TT. */
function terrestrialMillennia(date: Date): number {
  const days = universalDays(date)
  return (days + terrestrialLag(days / 36_525) / 86_400) / 365_250
}

/**
 * Apparent direction to the sun, unit length.
 *
 * @param distance - Distance of the sun, for the aberration [au].
 */
function direction(date: Date, distance: number, target: Vector3): Vector3 {
  const days = universalDays(date)
  // Julian centuries.
  const t = days / 36_525

  // Nutation by its two leading terms each; the rest is below 0.5″.
  const node = radians(125.04452 - 1934.136261 * t)
  const twiceMeanLongitude = radians(2 * (280.4665 + 36000.7698 * t))
  const arcseconds = radians(1 / 3600)
  const nutation = -arcseconds * (17.2 * Math.sin(node) + 1.32 * Math.sin(twiceMeanLongitude))
  const obliquity =
    radians(23.4392911 - 0.0130042 * t) +
    arcseconds * (9.2 * Math.cos(node) + 0.57 * Math.cos(twiceMeanLongitude))

  const longitude =
    series(longitudeTerms, terrestrialMillennia(date)) + Math.PI + nutation - aberration / distance
  // The sun's ecliptic latitude stays below 1.2″ and is left out.
  const x = Math.cos(longitude)
  const y = Math.sin(longitude) * Math.cos(obliquity)
  const z = Math.sin(longitude) * Math.sin(obliquity)

  const meanSiderealTime = radians(280.46061837 + 360.98564736629 * days + 0.000387933 * t * t)
  const angle = meanSiderealTime + nutation * Math.cos(obliquity)
  const c = Math.cos(angle)
  const s = Math.sin(angle)
  return target.set(c * x + s * y, c * y - s * x, z)
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
