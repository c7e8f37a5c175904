import geographiclib from 'geographiclib-geodesic'
import { checkFinite, checkPlace, fail } from './check'
import { checkEllipsoid, Ellipsoid } from './Ellipsoid'
import { Geodetic } from './Geodetic'
import type { GeodeticLike } from './Geodetic'

type Solver = InstanceType<typeof geographiclib.Geodesic.Geodesic>

/** The shortest path between two points of the surface. */
export interface GeodesicPath {
  /** Along the surface [m]. */
  distance: number
  /** Clockwise from north, at the start, in [−180, 180] [degrees]. */
  initialAzimuth: number
  /** Forward direction at the end, clockwise from north, in [−180, 180] [degrees]. */
  finalAzimuth: number
}

/**
 * Length of the shortest path along the surface. Heights are ignored.
 *
 * @param from - Degrees.
 * @param to - Degrees.
 * @param ellipsoid - A spheroid: radii x and y are equal.
 * @returns [m], exact to nanometres.
 * @throws Error if a value is not finite, a latitude is out of range, or the ellipsoid is triaxial.
 * @see Karney 2013, "Algorithms for geodesics", J. Geodesy 87, 43, §4 (inverse problem), through
 *   geographiclib-geodesic.
 */
export function geodesicDistance(
  from: GeodeticLike,
  to: GeodeticLike,
  ellipsoid: Ellipsoid = Ellipsoid.WGS84
): number {
  return solveInverse('geodesicDistance', from, to, ellipsoid).distance
}

/**
 * The shortest path along the surface: its length and its direction at both ends. Heights are
 * ignored. Between antipodes several paths are equally short; one of them is given.
 *
 * @param from - Degrees.
 * @param to - Degrees.
 * @param ellipsoid - A spheroid: radii x and y are equal.
 * @throws Error if a value is not finite, a latitude is out of range, or the ellipsoid is triaxial.
 */
export function geodesicInverse(
  from: GeodeticLike,
  to: GeodeticLike,
  ellipsoid: Ellipsoid = Ellipsoid.WGS84
): GeodesicPath {
  return solveInverse('geodesicInverse', from, to, ellipsoid)
}

/**
 * The place at a distance and direction along the surface. Its height is that of the start.
 *
 * @param from - Degrees.
 * @param azimuthDegrees - Direction at the start, clockwise from north [degrees].
 * @param distance - Along the surface [m]; negative goes backwards.
 * @param ellipsoid - A spheroid: radii x and y are equal.
 * @throws Error if a value is not finite, the latitude is out of range, or the ellipsoid is triaxial.
 */
export function geodesicDestination(
  from: GeodeticLike,
  azimuthDegrees: number,
  distance: number,
  ellipsoid: Ellipsoid = Ellipsoid.WGS84,
  target: Geodetic = new Geodetic()
): Geodetic {
  checkPlace('geodesicDestination', 'from', from)
  const { longitude, latitude, height = 0 } = from
  checkFinite('geodesicDestination', 'azimuthDegrees', azimuthDegrees)
  checkFinite('geodesicDestination', 'distance', distance)
  const solver = solverOf('geodesicDestination', ellipsoid)
  const { lon2 = 0, lat2 = 0 } = solver.Direct(latitude, longitude, azimuthDegrees, distance)
  return target.set(lon2, lat2, height)
}

function solveInverse(
  where: string,
  from: GeodeticLike,
  to: GeodeticLike,
  ellipsoid: Ellipsoid
): GeodesicPath {
  checkPlace(where, 'from', from)
  checkPlace(where, 'to', to)
  const { s12, azi1, azi2 } = solverOf(where, ellipsoid).Inverse(
    from.latitude,
    from.longitude,
    to.latitude,
    to.longitude
  )
  return { distance: s12 ?? 0, initialAzimuth: azi1 ?? 0, finalAzimuth: azi2 ?? 0 }
}

/** A solver's series coefficients depend on the flattening alone: worth keeping. */
const solvers = /*#__PURE__*/ new WeakMap<Ellipsoid, Solver>()

function solverOf(where: string, ellipsoid: Ellipsoid): Solver {
  const cached = solvers.get(ellipsoid)
  if (cached !== undefined) return cached
  checkEllipsoid(where, ellipsoid)
  const { x, y } = ellipsoid.radii
  if (x !== y) fail(where, 'ellipsoid must have equal radii x and y', ellipsoid.radii)
  const solver = new geographiclib.Geodesic.Geodesic(x, (x - ellipsoid.b) / x)
  solvers.set(ellipsoid, solver)
  return solver
}
