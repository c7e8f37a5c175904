import { Matrix4, Quaternion, Vector3 } from 'three'
import { eciToECEF, moonOrientation, moonPositionECEF, sunPositionECEF } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { MOON_DISTANCE } from './cpu/moonlight'

/** What is set by hand; null follows the date and the geometry. */
export interface MoonSettings {
  readonly direction: Vector3 | null
  readonly phase: number | null
  readonly distance: number | null
}

/** Where the moon is and how it is lit, from somewhere. All vectors are in ECEF, of unit length. */
export interface MoonGeometry {
  /** To the moon. */
  direction: Vector3
  /** [m] */
  distance: number
  /** Factor for its size, to eclipse a sun that is shown a little too large or small. */
  scale: number
  /** From the moon to the sun. */
  light: Vector3
  /** Between sun and observer, as seen from the moon, in [0, π] [rad]. */
  phaseAngle: number
  /** Moon-fixed axes. */
  axes: Quaternion
}

const POLE = /*#__PURE__*/ new Vector3(0, 0, 1)

/** The part of a vector across a unit vector, made a unit vector; another one across if there is none. */
function across(vector: Vector3, axis: Vector3): Vector3 {
  const part = vector.clone().addScaledVector(axis, -vector.dot(axis))
  if (part.lengthSq() > 1e-12) return part.normalize()
  const other = Math.abs(axis.x) < 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0)
  return part.crossVectors(axis, other).normalize()
}

/**
 * Terms of the sun's longitude that `sunPositionECEF` leaves out, (A, B, C) of A cos(B + C τ) with A in
 * 1e-8 rad and τ in thousands of Julian years from J2000: 8″ matter to an eclipse.
 *
 * @see Meeus, Astronomical Algorithms, 2nd ed., appendix III
 */
const LONGITUDE_REST: readonly (readonly [number, number, number])[] = [
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

/** Where the sun is, better than {@link sunPositionECEF} has it [m]. */
function exactSunECEF(date: Date, target: Vector3): Vector3 {
  const millennia = (date.getTime() - J2000) / MILLISECONDS_PER_MILLENNIUM
  const rest = LONGITUDE_REST.reduce((sum, [a, b, c]) => sum + a * Math.cos(b + c * millennia), 0)
  const obliquity = (23.44 * Math.PI) / 180
  const pole = new Vector3(0, -Math.sin(obliquity), Math.cos(obliquity))
  pole.transformDirection(eciToECEF(date))
  return sunPositionECEF(date, target).applyAxisAngle(pole, rest * 1e-8)
}

/** Sun and moon at a moment, from the Earth's centre. */
class Ephemeris {
  #time = NaN
  readonly sun = new Vector3()
  readonly moon = new Vector3()
  readonly axes = new Quaternion()

  at(date: Date): this {
    if (date.getTime() === this.#time) return this
    this.#time = date.getTime()
    exactSunECEF(date, this.sun)
    moonPositionECEF(date, this.moon)
    moonOrientation(date, this.axes)
    return this
  }
}

const _toECEF = new Matrix4()

/** Finds {@link MoonGeometry} for observers. */
export class MoonPlace {
  readonly #ephemeris = new Ephemeris()

  /** @param from - Observer, world. */
  seenFrom(atmosphere: Atmosphere, settings: MoonSettings, from: Vector3): MoonGeometry {
    const toECEF = _toECEF.copy(atmosphere.worldToECEF)
    const sun = atmosphere.sunDirection.transformDirection(toECEF)
    const { date } = atmosphere
    const { sunAngularRadius } = atmosphere.parameters
    const followsDate = date !== null && settings.direction === null
    const geometry = followsDate
      ? this.#byDate(date, from.clone().applyMatrix4(toECEF), sun, sunAngularRadius)
      : byHand(settings, sun, toECEF)
    if (settings.distance !== null) geometry.distance = settings.distance
    if (settings.phase !== null) lightByPhase(geometry, settings.phase, sun)
    geometry.phaseAngle = geometry.light.angleTo(geometry.direction.clone().negate())
    return geometry
  }

  #byDate(
    date: Date,
    observer: Vector3,
    shownSun: Vector3,
    sunAngularRadius: number
  ): MoonGeometry {
    const { sun, moon, axes } = this.#ephemeris.at(date)
    const direction = moon.clone().sub(observer)
    const distance = direction.length()
    const light = sun.clone().sub(moon).normalize()
    // The sun is shown up to 20″ from where it is: the moon moves along, so that eclipses are right.
    const sunFromHere = sun.clone().sub(observer).normalize()
    direction.divideScalar(distance).add(shownSun).sub(sunFromHere).normalize()
    const scale = sizeScale(direction.angleTo(shownSun), sun, sunAngularRadius)
    return { direction, distance, scale, light, phaseAngle: 0, axes: axes.clone() }
  }
}

/** Radius of the sun [m]: 959.63″ at an astronomical unit. */
const SUN_RADIUS = 6.96e8

/**
 * How much larger than it is the sun is shown, where the moon may eclipse it. The sun is shown at the
 * same size all year; a moon 2 % off is total where it should be annular.
 */
function sizeScale(separation: number, sun: Vector3, sunAngularRadius: number): number {
  const scale = (sunAngularRadius * sun.length()) / SUN_RADIUS
  const isNear = separation < (2 * Math.PI) / 180
  return isNear && Math.abs(scale - 1) < 0.03 ? scale : 1
}

/** A moon that turns its near side to the observer, north up. */
function byHand(settings: MoonSettings, sun: Vector3, toECEF: Matrix4): MoonGeometry {
  const direction =
    settings.direction?.clone().transformDirection(toECEF) ??
    // East of the sun by as much as the phase says; full is opposite the sun.
    sun.clone().applyAxisAngle(across(POLE, sun), 2 * Math.PI * (settings.phase ?? 0.5))
  const near = direction.clone().negate()
  const north = across(POLE, near)
  const east = new Vector3().crossVectors(north, near)
  const axes = new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(near, east, north))
  const distance = MOON_DISTANCE
  return { direction, distance, scale: 1, light: sun.clone(), phaseAngle: 0, axes }
}

/** Lights the moon as a phase says, from the side that is west while it waxes, along the line to the sun. */
function lightByPhase(geometry: MoonGeometry, phase: number, sun: Vector3): void {
  const { direction, light } = geometry
  const east = new Vector3().crossVectors(POLE, direction)
  const side = across(sun, direction)
  const isWest = side.dot(east) <= 0
  const turn = 2 * Math.PI * phase
  if (!isWest) side.negate()
  // Elongation 2πp to the east of the sun: from the moon, the sun is that far from the observer's far side.
  light.copy(direction).multiplyScalar(Math.cos(turn)).addScaledVector(side, Math.sin(turn))
}
