import { Matrix4, Quaternion, Vector3 } from 'three'
import type { Atmosphere } from '../Atmosphere'
import { MOON_DISTANCE } from './cpu/moonIrradiance'
import type { SunMoonEphemeris } from './sunMoonEphemeris'

/** Settings that override the date; null follows the date and the geometry. */
export interface MoonSettings {
  /** Direction to the moon, in world space, unit length. */
  readonly direction: Vector3 | null
  /** Phase: 0 new, 0.5 full, in [0, 1]. */
  readonly phase: number | null
  /** Observer to the moon's centre [m]. */
  readonly distance: number | null
}

/** Position and lighting of the moon for one observer. Vectors are of unit length. */
export interface MoonGeometry {
  /** Observer to moon. */
  directionECEF: Vector3
  /** Observer to the moon's centre [m]. */
  distance: number
  /** Factor on the moon's radius: as much as the sun's disc is drawn too large, see {@link discScale}. */
  scale: number
  /** Moon to sun. */
  sunDirectionECEF: Vector3
  /** Angle between sun and observer as seen from the moon, in [0, π] [rad]. */
  phaseAngle: number
  /** Moon-fixed axes to ECEF. */
  axes: Quaternion
}

const NORTH_ECEF = /*#__PURE__*/ new Vector3(0, 0, 1)

/** Part of a vector perpendicular to a unit vector, normalised; an arbitrary perpendicular if there is none. */
function perpendicularTo(vector: Vector3, axis: Vector3): Vector3 {
  const part = vector.clone().addScaledVector(axis, -vector.dot(axis))
  if (part.lengthSq() > 1e-12) return part.normalize()
  const other = Math.abs(axis.x) < 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0)
  return part.crossVectors(axis, other).normalize()
}

const _toECEF = new Matrix4()

/**
 * Geometry of the moon for one observer: from the date, from the settings, or from both.
 *
 * @param observerWorld - Position of the observer.
 */
export function moonGeometryFrom(
  ephemeris: SunMoonEphemeris,
  atmosphere: Atmosphere,
  settings: MoonSettings,
  observerWorld: Vector3
): MoonGeometry {
  const toECEF = _toECEF.copy(atmosphere.worldToECEF)
  const sunDirectionECEF = atmosphere.sunDirection.transformDirection(toECEF)
  const { date } = atmosphere
  const { sunAngularRadius } = atmosphere.parameters
  const geometry =
    date !== null && settings.direction === null
      ? geometryOfDate(
          ephemeris.at(date),
          observerWorld.clone().applyMatrix4(toECEF),
          sunDirectionECEF,
          sunAngularRadius
        )
      : geometryOfSettings(settings, sunDirectionECEF, toECEF)
  if (settings.distance !== null) geometry.distance = settings.distance
  if (settings.phase !== null) applyPhase(geometry, settings.phase, sunDirectionECEF)
  const toObserver = geometry.directionECEF.clone().negate()
  geometry.phaseAngle = geometry.sunDirectionECEF.angleTo(toObserver)
  return geometry
}

/** @param drawnSunECEF - Direction to the sun as the atmosphere draws it, up to 20″ from where it is. */
function geometryOfDate(
  { sunECEF, moonECEF, moonAxes }: SunMoonEphemeris,
  observerECEF: Vector3,
  drawnSunECEF: Vector3,
  sunAngularRadius: number
): MoonGeometry {
  const directionECEF = moonECEF.clone().sub(observerECEF)
  const distance = directionECEF.length()
  const sunDirectionECEF = sunECEF.clone().sub(moonECEF).normalize()
  // The moon is shifted as the drawn sun is, so that eclipses are right.
  const exactSunECEF = sunECEF.clone().sub(observerECEF).normalize()
  directionECEF.divideScalar(distance).add(drawnSunECEF).sub(exactSunECEF).normalize()
  const scale = discScale(directionECEF.angleTo(drawnSunECEF), sunECEF, sunAngularRadius)
  return { directionECEF, distance, scale, sunDirectionECEF, phaseAngle: 0, axes: moonAxes.clone() }
}

/** Radius of the sun [m]: 959.63″ at an astronomical unit. */
const SUN_RADIUS = 6.96e8

/**
 * Ratio of the sun's drawn to its true angular radius near an eclipse, else 1. The sun is drawn at one
 * size all year: without this factor on the moon, an annular eclipse could come out total.
 */
function discScale(separation: number, sunECEF: Vector3, sunAngularRadius: number): number {
  const scale = (sunAngularRadius * sunECEF.length()) / SUN_RADIUS
  const isNear = separation < (2 * Math.PI) / 180
  return isNear && Math.abs(scale - 1) < 0.03 ? scale : 1
}

/** Geometry without a date: the near side faces the observer, north up. */
function geometryOfSettings(
  settings: MoonSettings,
  sunDirectionECEF: Vector3,
  toECEF: Matrix4
): MoonGeometry {
  const directionECEF =
    settings.direction?.clone().transformDirection(toECEF) ??
    // Elongation 2πp east of the sun; a full moon is opposite it.
    sunDirectionECEF
      .clone()
      .applyAxisAngle(
        perpendicularTo(NORTH_ECEF, sunDirectionECEF),
        2 * Math.PI * (settings.phase ?? 0.5)
      )
  const near = directionECEF.clone().negate()
  const north = perpendicularTo(NORTH_ECEF, near)
  const east = new Vector3().crossVectors(north, near)
  return {
    directionECEF,
    distance: MOON_DISTANCE,
    scale: 1,
    sunDirectionECEF: sunDirectionECEF.clone(),
    phaseAngle: 0,
    axes: new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(near, east, north))
  }
}

/** Lights the moon by its phase: from the west while it waxes, along the great circle to the sun. */
function applyPhase(geometry: MoonGeometry, phase: number, drawnSunECEF: Vector3): void {
  const { directionECEF, sunDirectionECEF } = geometry
  const east = new Vector3().crossVectors(NORTH_ECEF, directionECEF)
  const side = perpendicularTo(drawnSunECEF, directionECEF)
  const isWest = side.dot(east) <= 0
  if (!isWest) side.negate()
  // As seen from the moon, the sun is the elongation 2πp away from the direction opposite the observer.
  const elongation = 2 * Math.PI * phase
  sunDirectionECEF
    .copy(directionECEF)
    .multiplyScalar(Math.cos(elongation))
    .addScaledVector(side, Math.sin(elongation))
}
