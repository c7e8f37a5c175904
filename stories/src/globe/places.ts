import { Ellipsoid } from '@welkin/geo'
import { Matrix4, PerspectiveCamera, Vector3 } from 'three'
import type { Explorer } from '../moving/Explorer'

/** Position and direction of the camera. */
export interface Place {
  label: string
  /** [degrees] */
  longitude: number
  /** [degrees] */
  latitude: number
  /** Height above the ellipsoid [m]. */
  height: number
  /** Clockwise from north [degrees]. */
  heading: number
  /** Angle above the horizontal [degrees]. */
  pitch: number
}

/** Middle of the made-up city block, near Tokyo's main station. */
export const CITY = { longitude: 139.767, latitude: 35.681 }

export const PLACES = {
  street: { label: 'Tokyo, street, 2 m', ...CITY, height: 2, heading: 248, pitch: 4 },
  rooftops: {
    label: 'Tokyo, 1 km',
    longitude: 139.784,
    latitude: 35.686,
    height: 1000,
    heading: 252,
    pitch: -19
  },
  coast: {
    label: 'Tokyo Bay, 10 km',
    longitude: 140.1,
    latitude: 35.3,
    height: 10_000,
    heading: 300,
    pitch: -6
  },
  orbit: {
    label: 'Japan, 400 km',
    longitude: 141.5,
    latitude: 32,
    height: 400_000,
    heading: 325,
    pitch: -20
  },
  eastCoast: {
    label: 'America, 400 km',
    longitude: -70,
    latitude: 26.5,
    height: 400_000,
    heading: 333,
    pitch: -22
  },
  globe: {
    label: 'Asia, 20,000 km',
    longitude: 125,
    latitude: 20,
    height: 20_000_000,
    heading: 0,
    pitch: -90
  },
  europe: {
    label: 'Europe and Africa, 20,000 km',
    longitude: 15,
    latitude: 26,
    height: 20_000_000,
    heading: 0,
    pitch: -90
  },
  // 2 m above the tileset's finest triangles.
  valley: {
    label: 'Tennessee, valley, 2 m',
    longitude: -84.178,
    latitude: 36.622,
    height: 341.8,
    heading: 318,
    pitch: 5
  },
  ridges: {
    label: 'Tennessee, ridges, 1 km',
    longitude: -84.1517,
    latitude: 36.479,
    height: 1330,
    heading: 322,
    pitch: -10
  }
} satisfies Record<string, Place>

export type PlaceName = keyof typeof PLACES

const frame = new Matrix4()
const east = new Vector3()
const north = new Vector3()
const up = new Vector3()
const forward = new Vector3()
const back = new Vector3()
const right = new Vector3()
const radians = Math.PI / 180

/** Puts a camera at a place of a world that is ECEF, in metres. */
export function moveCamera(camera: PerspectiveCamera, place: Place): PerspectiveCamera {
  const position = Ellipsoid.WGS84.geodeticToECEF(place)
  Ellipsoid.WGS84.eastNorthUpFrame(position, frame).extractBasis(east, north, up)
  const heading = place.heading * radians
  const pitch = place.pitch * radians
  forward
    .copy(north)
    .multiplyScalar(Math.cos(heading) * Math.cos(pitch))
    .addScaledVector(east, Math.sin(heading) * Math.cos(pitch))
    .addScaledVector(up, Math.sin(pitch))
  right.copy(east).multiplyScalar(Math.cos(heading)).addScaledVector(north, -Math.sin(heading))
  back.copy(forward).negate()
  up.crossVectors(back, right)
  camera.quaternion.setFromRotationMatrix(frame.makeBasis(right, up, back))
  camera.position.copy(position)
  camera.updateMatrixWorld()
  return camera
}

/** Position, and unit vector of the direction, of a camera in a world that is ECEF. */
export interface View {
  readonly position: Vector3
  readonly direction: Vector3
}

/** View of a place. */
export function viewAt(place: Place): View {
  const camera = moveCamera(new PerspectiveCamera(), place)
  return { position: camera.position, direction: camera.getWorldDirection(new Vector3()) }
}

/** Has a camera look from a view, upright. */
export function lookFrom(camera: PerspectiveCamera, { position, direction }: View): void {
  camera.position.copy(position)
  Ellipsoid.WGS84.surfaceNormal(position, camera.up)
  camera.lookAt(forward.copy(position).add(direction))
  camera.updateMatrixWorld()
}

/**
 * Flies to a view, the longer the farther it is.
 *
 * @param camera - That of the explorer.
 * @returns Promise that settles on arrival, or when the flight is broken off.
 */
export function flyToView(
  explorer: Explorer,
  camera: PerspectiveCamera,
  view: View
): Promise<void> {
  const distance = camera.position.distanceTo(view.position)
  return explorer.flyTo(view, 1 + 0.5 * Math.log10(1 + distance))
}

/** Flies to a place of a world that is ECEF: see {@link flyToView}. */
export const flyToPlace = (
  explorer: Explorer,
  camera: PerspectiveCamera,
  place: Place
): Promise<void> => flyToView(explorer, camera, viewAt(place))
