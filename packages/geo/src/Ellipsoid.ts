import { Matrix4, Sphere, Vector3 } from 'three'
import { checkDirection, checkFinite, checkPlace, checkPositive, checkVector, fail } from './check'
import { footPointNormal } from './footPoint'
import { Geodetic } from './Geodetic'
import type { GeodeticLike } from './Geodetic'

const degrees = Math.PI / 180

/**
 * An ellipsoid centred on the origin of an Earth-centred, Earth-fixed (ECEF) frame: X through
 * longitude 0°, Y through 90° east, Z through the north pole. Any three radii.
 *
 * All computation is in float64. Positions are ECEF in metres unless a name says otherwise; a
 * `target` receives the result, is returned, and may be the input itself.
 *
 * ```ts
 * const positionECEF = Ellipsoid.WGS84.geodeticToECEF({ longitude: 139.77, latitude: 35.68 })
 * const up = Ellipsoid.WGS84.surfaceNormal(positionECEF)
 * ```
 */
export class Ellipsoid {
  /** The Earth's reference ellipsoid: a = 6378137 m, 1/f = 298.257223563 (NGA.STND.0036). */
  static readonly WGS84: Ellipsoid = /*#__PURE__*/ new Ellipsoid(
    6378137,
    6378137,
    6356752.314245179
  )

  /** Radii along X, Y and Z [m]. Frozen. */
  readonly radii: Vector3

  /**
   * @param x - Radius along X [m].
   * @param y - Radius along Y [m]; `x` if left out.
   * @param z - Radius along Z [m]; `x` if left out.
   * @throws Error unless every radius is positive and finite.
   */
  constructor(x: number, y: number = x, z: number = x) {
    checkPositive('Ellipsoid', 'radius x', x)
    checkPositive('Ellipsoid', 'radius y', y)
    checkPositive('Ellipsoid', 'radius z', z)
    this.radii = Object.freeze(new Vector3(x, y, z))
  }

  /**
   * Ellipsoid from a structure with a `radius` or `radii` vector, such as the `Ellipsoid` of 3d-tiles-renderer.
   *
   * @throws Error unless every radius is positive and finite.
   */
  static from(source: { readonly radius: Vector3 } | { readonly radii: Vector3 }): Ellipsoid {
    const { x, y, z } = 'radii' in source ? source.radii : source.radius
    return new Ellipsoid(x, y, z)
  }

  /** Radius along X: the equatorial radius of a spheroid [m]. */
  get a(): number {
    return this.radii.x
  }

  /** Radius along Z: the polar radius [m]. */
  get b(): number {
    return this.radii.z
  }

  /** Largest of the three radii [m]. */
  get maximumRadius(): number {
    return Math.max(...this.radii)
  }

  /** Smallest of the three radii [m]. */
  get minimumRadius(): number {
    return Math.min(...this.radii)
  }

  /**
   * The ellipsoid whose radii are larger by a height: within h·f² of the surface at that height
   * (1 m at 100 km above the Earth).
   *
   * @param height - [m], above −(smallest radius).
   */
  grown(height: number): Ellipsoid {
    checkFinite('Ellipsoid.grown', 'height', height)
    const { x, y, z } = this.radii
    return new Ellipsoid(x + height, y + height, z + height)
  }

  /**
   * Geodetic coordinates to ECEF.
   *
   * @param geodetic - Degrees, degrees, metres (0 if left out).
   * @returns ECEF [m].
   * @throws Error if a value is not finite or the latitude is outside [−90, 90].
   */
  geodeticToECEF(geodetic: GeodeticLike, target: Vector3 = new Vector3()): Vector3 {
    checkPlace('Ellipsoid.geodeticToECEF', 'geodetic', geodetic)
    const { longitude, latitude, height = 0 } = geodetic
    const { x, y, z } = this.radii
    const cosLatitude = Math.cos(latitude * degrees)
    const normal = scratchNormal.set(
      cosLatitude * Math.cos(longitude * degrees),
      cosLatitude * Math.sin(longitude * degrees),
      Math.sin(latitude * degrees)
    )
    const support = this.support(normal)
    return target
      .set((x * x) / support + height, (y * y) / support + height, (z * z) / support + height)
      .multiply(normal)
  }

  /**
   * ECEF to geodetic coordinates of the nearest point of the surface. There and back differs by
   * less than 1 µm up to the Moon's distance; within 43 km of the Earth's centre, where normals
   * cross, the nearest of several answers is given.
   *
   * @param positionECEF - [m], finite.
   * @returns Longitude in [−180, 180], latitude, height.
   * @throws Error if a component is not finite.
   */
  ecefToGeodetic(positionECEF: Vector3, target: Geodetic = new Geodetic()): Geodetic {
    const normal = this.normal('ecefToGeodetic', positionECEF)
    const { x, y, z } = positionECEF
    return target.set(
      Math.atan2(normal.y, normal.x) / degrees,
      Math.atan2(normal.z, Math.hypot(normal.x, normal.y)) / degrees,
      x * normal.x + y * normal.y + z * normal.z - this.support(normal)
    )
  }

  /**
   * Height above the surface, negative inside [m].
   *
   * @throws Error if a component is not finite.
   */
  heightAt(positionECEF: Vector3): number {
    return this.ecefToGeodetic(positionECEF, scratchGeodetic).height
  }

  /**
   * The nearest point of the surface.
   *
   * @param positionECEF - [m], finite.
   * @returns ECEF [m].
   * @throws Error if a component is not finite.
   */
  footPoint(positionECEF: Vector3, target: Vector3 = new Vector3()): Vector3 {
    const normal = this.normal('footPoint', positionECEF)
    const { x, y, z } = this.radii
    return target
      .set(x * x, y * y, z * z)
      .multiply(normal)
      .divideScalar(this.support(normal))
  }

  /**
   * Geodetic up: the outward unit normal at the nearest point of the surface.
   *
   * @param positionECEF - [m], finite; need not be on the surface.
   * @throws Error if a component is not finite.
   */
  surfaceNormal(positionECEF: Vector3, target: Vector3 = new Vector3()): Vector3 {
    return this.normal('surfaceNormal', positionECEF, target)
  }

  /**
   * East-north-up frame at a position: takes local (east, north, up) [m] to ECEF. On the polar
   * axis, where east is undefined, it is that of longitude 0°.
   *
   * @param positionECEF - Origin of the frame [m], finite.
   * @returns Columns east, north, up, origin.
   * @throws Error if a component is not finite.
   */
  eastNorthUpFrame(positionECEF: Vector3, target: Matrix4 = new Matrix4()): Matrix4 {
    this.basis('eastNorthUpFrame', positionECEF)
    return target.makeBasis(scratchEast, scratchNorth, scratchNormal).setPosition(positionECEF)
  }

  /**
   * Frame in three's own convention (Y up) at a position: takes local (X east, Y up, Z south) [m]
   * to ECEF. On the polar axis east is that of longitude 0°.
   *
   * @param positionECEF - Origin of the frame [m], finite.
   * @returns Columns east, up, south, origin.
   * @throws Error if a component is not finite.
   */
  localYUpFrame(positionECEF: Vector3, target: Matrix4 = new Matrix4()): Matrix4 {
    this.basis('localYUpFrame', positionECEF)
    return target
      .makeBasis(scratchEast, scratchNormal, scratchNorth.negate())
      .setPosition(positionECEF)
  }

  /**
   * Point where a ray first meets the surface; from inside, where it leaves.
   *
   * @param originECEF - [m], finite.
   * @param directionECEF - Any non-zero length.
   * @returns ECEF [m], or null if the ray misses.
   * @throws Error if a component is not finite or the direction is zero.
   */
  intersectRay(
    originECEF: Vector3,
    directionECEF: Vector3,
    target: Vector3 = new Vector3()
  ): Vector3 | null {
    const distance = this.intersectRayDistance(originECEF, directionECEF)
    if (distance === null) return null
    const scale = distance / scratchDirection.copy(directionECEF).length()
    return target.copy(originECEF).addScaledVector(scratchDirection, scale)
  }

  /**
   * Distance along a ray to where it first meets the surface; from inside, to where it leaves.
   *
   * In the space where the ellipsoid is the unit sphere, d² − 2·d·(−p·v) + p² − 1 = 0; the root that
   * would cancel comes from the product of the two.
   *
   * @param originECEF - [m], finite.
   * @param directionECEF - Any non-zero length.
   * @returns [m], ≥ 0, or null if the ray misses.
   * @throws Error if a component is not finite or the direction is zero.
   */
  intersectRayDistance(originECEF: Vector3, directionECEF: Vector3): number | null {
    checkVector('Ellipsoid.intersectRay', 'originECEF', originECEF)
    checkDirection('Ellipsoid.intersectRay', 'directionECEF', directionECEF)
    const origin = scratchOrigin.copy(originECEF).divide(this.radii)
    const length = directionECEF.length()
    const direction = scratchDirection.copy(directionECEF).divideScalar(length).divide(this.radii)
    const scale = direction.length()
    direction.divideScalar(scale)
    const towards = -origin.dot(direction)
    const outside = (origin.length() - 1) * (origin.length() + 1)
    // |p × v| is the ray's distance from the centre: exact where towards² − outside would cancel.
    const miss = origin.cross(direction).length()
    const discriminant = (1 - miss) * (1 + miss)
    if (discriminant < 0 || (outside > 0 && towards < 0)) return null
    const far = towards + Math.sign(towards || 1) * Math.sqrt(discriminant)
    const product = far === 0 ? 0 : outside / far
    return Math.max(outside > 0 ? product : Math.max(far, product), 0) / scale
  }

  /**
   * The map that takes this ellipsoid to a sphere of radius `a`: v ↦ a·(vx/rx, vy/ry, vz/rz). It is
   * linear, so it serves positions and displacements alike (a direction's length changes: use
   * `directionToSphere` for a unit one). For a surface point p and any v, S(v)·S(p) has the sign
   * of v·n, n the geodetic normal: horizon and terminator are exact in the mapped space.
   *
   * @param vector - Position or displacement in ECEF.
   */
  toSphere(vector: Vector3, target: Vector3 = new Vector3()): Vector3 {
    const { x, y, z } = this.radii
    return target.set(vector.x, vector.y * (x / y), vector.z * (x / z))
  }

  /** The inverse of `toSphere`. */
  fromSphere(vector: Vector3, target: Vector3 = new Vector3()): Vector3 {
    const { x, y, z } = this.radii
    return target.set(vector.x, vector.y / (x / y), vector.z / (x / z))
  }

  /**
   * Unit direction in the mapped space of a direction in ECEF.
   *
   * @throws Error if the direction is zero or not finite.
   */
  directionToSphere(direction: Vector3, target: Vector3 = new Vector3()): Vector3 {
    checkDirection('Ellipsoid.directionToSphere', 'direction', direction)
    return this.toSphere(direction, target).normalize()
  }

  /**
   * Unit direction in ECEF of a direction in the mapped space.
   *
   * @throws Error if the direction is zero or not finite.
   */
  directionFromSphere(direction: Vector3, target: Vector3 = new Vector3()): Vector3 {
    checkDirection('Ellipsoid.directionFromSphere', 'direction', direction)
    return this.fromSphere(direction, target).normalize()
  }

  /**
   * Distance from the centre to the surface beneath a position [m].
   *
   * @throws Error if a component is not finite.
   */
  localGroundRadius(positionECEF: Vector3): number {
    return this.footPoint(positionECEF, scratchOrigin).length()
  }

  /**
   * Sphere that touches the surface from inside at the point beneath a position. Its radius is the
   * Gaussian radius of curvature there (√(M·N) of a spheroid) unless one is given.
   *
   * @param positionECEF - [m], finite.
   * @param radius - Radius of the sphere, > 0 [m].
   * @returns Centre in ECEF [m] and radius [m].
   * @throws Error if a component is not finite or the radius is not positive.
   */
  osculatingSphere(positionECEF: Vector3, radius?: number, target: Sphere = new Sphere()): Sphere {
    const foot = this.footPoint(positionECEF, scratchOrigin)
    const { x, y, z } = this.radii
    // Gaussian curvature is h⁴/(x y z)², h the support.
    const value = radius ?? (x * y * z) / this.support(scratchNormal) ** 2
    checkPositive('Ellipsoid.osculatingSphere', 'radius', value)
    target.center.copy(foot).addScaledVector(scratchNormal, -value)
    target.radius = value
    return target
  }

  /** Geodetic up at a position that a method was given, which it checks. */
  private normal(method: string, positionECEF: Vector3, target = scratchNormal): Vector3 {
    checkVector(`Ellipsoid.${method}`, 'positionECEF', positionECEF)
    return footPointNormal(positionECEF, this.radii, target)
  }

  /** The support function: distance from the centre to the tangent plane of a normal [m]. */
  private support(normal: Vector3): number {
    const { x, y, z } = this.radii
    return Math.hypot(x * normal.x, y * normal.y, z * normal.z)
  }

  /** Leaves east, north and up in the scratch vectors. */
  private basis(method: string, positionECEF: Vector3): void {
    const up = this.normal(method, positionECEF)
    const horizontal = Math.hypot(up.x, up.y)
    if (horizontal > 0) scratchEast.set(-up.y / horizontal, up.x / horizontal, 0)
    else scratchEast.set(0, 1, 0)
    scratchNorth.crossVectors(up, scratchEast)
  }
}

const scratchNormal = /*#__PURE__*/ new Vector3()
const scratchEast = /*#__PURE__*/ new Vector3()
const scratchNorth = /*#__PURE__*/ new Vector3()
const scratchOrigin = /*#__PURE__*/ new Vector3()
const scratchDirection = /*#__PURE__*/ new Vector3()
const scratchGeodetic = /*#__PURE__*/ new Geodetic()

/** @throws If it is no ellipsoid. */
export function checkEllipsoid(where: string, value: Ellipsoid): void {
  if (!(value instanceof Ellipsoid)) fail(where, 'ellipsoid must be an Ellipsoid', value)
}
