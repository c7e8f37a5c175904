import { Vector3 } from 'three'
import type { Matrix4 } from 'three'
import { checkFinite, checkOptions, checkVector, fail } from './check'
import { checkEllipsoid, Ellipsoid } from './Ellipsoid'

/** Options of the distances to the horizon. */
export interface HorizonOptions {
  /** Default `Ellipsoid.WGS84`. */
  ellipsoid?: Ellipsoid
  /** Direction of view, clockwise from north [degrees], default 0. */
  azimuthDegrees?: number
}

/**
 * Distance in a straight line to the horizon: where the line of sight touches the ellipsoid. No
 * terrain and no refraction; exact on any ellipsoid, from any altitude.
 *
 * @param positionECEF - Viewpoint [m].
 * @returns [m]; 0 on or below the surface.
 * @throws Error if a value is not finite.
 */
export function horizonDistance(positionECEF: Vector3, options: HorizonOptions = {}): number {
  return tangentRay('horizonDistance', positionECEF, 0, options).distance
}

/**
 * Angle from the horizontal plane down to the horizon.
 *
 * @param positionECEF - Viewpoint [m].
 * @returns In [0, π/2) [rad]; 0 on or below the surface.
 * @throws Error if a value is not finite.
 */
export function horizonDip(positionECEF: Vector3, options: HorizonOptions = {}): number {
  return tangentRay('horizonDip', positionECEF, 0, options).dip
}

/**
 * Distance in a straight line to where the line of sight touches the limb at a height above the
 * ellipsoid: a layer of air or of haze as seen from above it. At height 0 it is the horizon's.
 *
 * @param positionECEF - Viewpoint [m].
 * @param limbHeight - Tangent height [m], above −(smallest radius).
 * @returns [m]; 0 on or below that height.
 * @throws Error if a value is not finite.
 */
export function tangentLimbDistance(
  positionECEF: Vector3,
  limbHeight: number,
  options: HorizonOptions = {}
): number {
  checkFinite('tangentLimbDistance', 'limbHeight', limbHeight)
  return tangentRay('tangentLimbDistance', positionECEF, limbHeight, options).distance
}

/**
 * Distance beyond which nothing of a given height can be seen: the line of sight touches the
 * surface at the horizon and rises behind it until it is that high. Mountains show above the horizon
 * up to here.
 *
 * @param positionECEF - Viewpoint [m].
 * @param targetHeight - Greatest height of what is to be seen, above the ellipsoid [m].
 * @param surfaceHeight - Height of the surface that hides it [m], at most `targetHeight`; default 0.
 * @returns [m].
 * @throws Error if a value is not finite or `targetHeight` is below `surfaceHeight`.
 */
export function visibleDistance(
  positionECEF: Vector3,
  targetHeight: number,
  surfaceHeight = 0,
  options: HorizonOptions = {}
): number {
  checkFinite('visibleDistance', 'targetHeight', targetHeight)
  checkFinite('visibleDistance', 'surfaceHeight', surfaceHeight)
  if (targetHeight < surfaceHeight) {
    fail(
      'visibleDistance',
      `targetHeight must be at least surfaceHeight (${surfaceHeight})`,
      targetHeight
    )
  }
  const ray = tangentRay('visibleDistance', positionECEF, surfaceHeight, options)
  const shell = (options.ellipsoid ?? Ellipsoid.WGS84).grown(targetHeight)
  const tangentPoint = positionECEF.clone().addScaledVector(ray.direction, ray.distance)
  return ray.distance + (shell.intersectRayDistance(tangentPoint, ray.direction) ?? 0)
}

interface TangentRay {
  /** ECEF, unit length. */
  direction: Vector3
  /** Distance from the viewpoint to the tangent point [m]. */
  distance: number
  /** Angle below the level [rad]. */
  dip: number
}

/**
 * The ray in a vertical plane that touches the ellipsoid grown by `height`.
 *
 * With all vectors in the space where the ellipsoid is a sphere of radius a, a ray p + t·d touches
 * it if (d·p)² = |d|² (|p|² − a²). For d = A − τB, A horizontal, B up and τ the tangent of the dip,
 * that is a quadratic in τ with one root ahead (positive) and one behind.
 */
function tangentRay(
  where: string,
  positionECEF: Vector3,
  height: number,
  options: HorizonOptions
): TangentRay {
  checkOptions(where, options, 'ellipsoid', 'azimuthDegrees')
  const { ellipsoid = Ellipsoid.WGS84, azimuthDegrees = 0 } = options
  checkEllipsoid(where, ellipsoid)
  checkVector(where, 'positionECEF', positionECEF)
  checkFinite(where, 'azimuthDegrees', azimuthDegrees)
  const surface = height === 0 ? ellipsoid : ellipsoid.grown(height)
  const frame = ellipsoid.eastNorthUpFrame(positionECEF)
  const azimuth = (azimuthDegrees * Math.PI) / 180
  const horizontal = rotate(frame, Math.sin(azimuth), Math.cos(azimuth), 0)
  const up = rotate(frame, 0, 0, 1)

  const p = surface.toSphere(positionECEF)
  const gap = (p.length() - surface.a) * (p.length() + surface.a)
  if (gap <= 0) return { direction: horizontal, distance: 0, dip: 0 }
  const a = surface.toSphere(horizontal)
  const b = surface.toSphere(up)
  const ap = a.dot(p)
  const bp = b.dot(p)
  const square = bp * bp - b.dot(b) * gap
  const half = a.dot(b) * gap - ap * bp
  const constant = ap * ap - a.dot(a) * gap
  const slope = (Math.sqrt(Math.max(half * half - square * constant, 0)) - half) / square
  const dip = Math.atan(slope)

  const direction = horizontal.multiplyScalar(Math.cos(dip)).addScaledVector(up, -Math.sin(dip))
  const d = surface.toSphere(direction)
  return { direction, distance: Math.max(-d.dot(p) / d.dot(d), 0), dip }
}

function rotate(frame: Matrix4, east: number, north: number, up: number): Vector3 {
  return new Vector3(east, north, up).transformDirection(frame)
}
