import { MathUtils, Quaternion, SphereGeometry, Vector3 } from 'three'
import type { Object3D, PerspectiveCamera } from 'three'

/** Time from the map to the ground [s]. */
export const DESCENT_SECONDS = 45

/** Camera of the map, and what it looks at, from the Earth's centre [Earth's radii]. */
const MAP = { from: new Vector3(1.3, 0.8, 4.2), to: new Vector3(1.3, 0, 0) } as const
/** Height of the eyes of who has landed [km]. */
const LANDED = 0.002
/** Parts of the descent in which the way leads over the landing place, and from the map's view to the horizon. */
const OVERHEAD = 0.6
const TURNED = 0.35

/** Parts of the descent between which the cockpit comes up around the camera, and the way that it does [km]. */
const BOARDING = [0.12, 0.3] as const
const CLIMB = 0.0025

/** Place of the landing, in the Alps: the zenith of the world [degrees]. */
const PLACE = { latitude: 46.5, longitude: 9 } as const

/** Half width of the ground that is flat to metres, and how much lower the coarse globe under it is. */
const CAP = 0.4
const LOWERED = 0.9995

/** Direction of a place on three's sphere, whose texture coordinates are those of a map from 180° west. */
function directionOf({ latitude, longitude }: typeof PLACE): Vector3 {
  const [lat, lon] = [latitude, longitude].map(MathUtils.degToRad)
  return new Vector3(Math.cos(lat) * Math.cos(lon), Math.sin(lat), -Math.cos(lat) * Math.sin(lon))
}

/** Rotation that brings the landing place to the zenith. */
export const toZenith = (): Quaternion =>
  new Quaternion().setFromUnitVectors(directionOf(PLACE), new Vector3(0, 1, 0))

/** A globe of radius 1, a little lower than the ground about the landing place, which goes over it. */
export const coarseGlobe = (): SphereGeometry => new SphereGeometry(LOWERED, 256, 128)

/**
 * The ground about the landing place, the finer the nearer, from there: a globe's own vertices are half a metre off. It has
 * the globe's texture coordinates.
 *
 * @param radius - The Earth's radius [km].
 */
export function landingGround(radius: number): SphereGeometry {
  const geometry = new SphereGeometry(1, 256, 256, 0, 2 * Math.PI, 0, CAP)
  const { position, normal, uv } = geometry.attributes
  const turn = toZenith().invert()
  const direction = new Vector3()
  for (let i = 0; i < position.count; i++) {
    direction.fromBufferAttribute(position, i)
    const azimuth = Math.atan2(direction.z, direction.x)
    const angle = Math.acos(MathUtils.clamp(direction.y, -1, 1)) ** 2 / CAP
    const sine = Math.sin(angle)
    direction.set(sine * Math.cos(azimuth), Math.cos(angle), sine * Math.sin(azimuth))
    const drop = 2 * Math.sin(angle / 2) ** 2
    position.setXYZ(i, radius * direction.x, -radius * drop, radius * direction.z)
    normal.setXYZ(i, direction.x, direction.y, direction.z)
    const { x, y, z } = direction.applyQuaternion(turn)
    uv.setXY(i, 0.5 + Math.atan2(-z, x) / (2 * Math.PI), 0.5 + Math.asin(y) / Math.PI)
  }
  return geometry
}

const _up = new Vector3()
const _ahead = new Vector3()
const _mapView = new Quaternion()

/**
 * Puts a camera on the way from the map to the ground.
 *
 * @param part - Part of the descent, in [0, 1].
 * @param center - The Earth's centre [km].
 * @param radius - The Earth's radius [km].
 */
export function descend(
  camera: PerspectiveCamera,
  part: number,
  center: Vector3,
  radius: number
): void {
  const highest = radius * (MAP.from.length() - 1)
  const fall = MathUtils.smootherstep(part, 0, 1)
  const height = highest * (LANDED / highest) ** fall
  const overhead = MathUtils.smootherstep(part, 0, OVERHEAD)
  _up
    .copy(MAP.from)
    .normalize()
    .lerp(new Vector3(0, 1, 0), overhead)
    .normalize()
  camera.position.copy(center).addScaledVector(_up, radius + height)

  camera.up.set(0, 1, 0)
  camera.lookAt(_ahead.copy(MAP.to).multiplyScalar(radius).add(center))
  _mapView.copy(camera.quaternion)
  // The horizon stays in the middle.
  const dip = Math.acos(radius / (radius + height))
  _ahead.set(0, 0, -1).addScaledVector(_up, _up.z).normalize()
  _ahead.multiplyScalar(Math.cos(dip)).addScaledVector(_up, -Math.sin(dip))
  camera.up.copy(_up)
  camera.lookAt(_ahead.add(camera.position))
  camera.quaternion.slerp(_mapView, 1 - MathUtils.smootherstep(part, 0, TURNED))
  camera.up.set(0, 1, 0)
  camera.updateMatrixWorld()
}

/** True where the cockpit is all around the camera. */
export const isAboard = (part: number): boolean => part >= BOARDING[1]

/** Turns a cockpit, which is where the camera is, as the camera is turned; on the map it is still below. */
export function boardCockpit(cockpit: Object3D, camera: PerspectiveCamera, part: number): void {
  cockpit.quaternion.copy(camera.quaternion)
  cockpit.translateY((MathUtils.smootherstep(part, ...BOARDING) - 1) * CLIMB)
}
