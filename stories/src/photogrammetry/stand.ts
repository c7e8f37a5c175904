import { Ellipsoid } from '@welkin/geo'
import { Matrix4, Vector3 } from 'three'
import type { PerspectiveCamera, Sphere } from 'three'
import type { View } from '../globe/places'
import { SIGHTS } from './places'

/** Radius from which on a tileset is of the whole world [m]. */
const WORLD = 3e6

/** Distance from the Earth's centre below which nothing stands [m]: a tileset there has coordinates of its own. */
const DEEP = 6e6

/** Angle below the horizontal at which one looks at a tileset [rad]. */
const PITCH = Math.PI / 6

/** Part of the picture's height that a tileset fills. */
const SHARE = 0.8

/** Way in which a tileset stands on the Earth: all over it, at one place, or with coordinates of its own, z up. */
export type Stand = 'world' | 'place' | 'own'

/** @param bounds - Sphere around the tileset, in its own coordinates [m]. */
export function standOf({ center, radius }: Sphere): Stand {
  if (radius >= WORLD) return 'world'
  return center.length() < DEEP ? 'own' : 'place'
}

/** ECEF of a tileset with coordinates of its own: it is put down where the local tiles are. */
export function groundedFrame({ center, radius }: Sphere): Matrix4 {
  const { longitude, latitude } = SIGHTS.local
  // Nothing of it is below the ellipsoid.
  const height = Math.max(radius - center.z, 0)
  const origin = Ellipsoid.WGS84.geodeticToECEF({ longitude, latitude, height })
  return Ellipsoid.WGS84.eastNorthUpFrame(origin, new Matrix4())
}

/** View of a tileset from the south, slightly from above, which has all of it in the picture. */
export function viewOf(
  { center, radius }: Sphere,
  { fov, aspect }: Pick<PerspectiveCamera, 'fov' | 'aspect'>
): View {
  const [east, north, up] = [new Vector3(), new Vector3(), new Vector3()]
  Ellipsoid.WGS84.eastNorthUpFrame(center, new Matrix4()).extractBasis(east, north, up)
  const direction = north.multiplyScalar(Math.cos(PITCH)).addScaledVector(up, -Math.sin(PITCH))
  const half = Math.atan(Math.tan((fov * Math.PI) / 360) * Math.min(aspect, 1))
  const distance = radius / Math.sin(half * SHARE)
  return { position: center.clone().addScaledVector(direction, -distance), direction }
}

/** Place in words, to a thousandth of a degree. */
export function placeInWords(position: Vector3): string {
  const { longitude, latitude } = Ellipsoid.WGS84.ecefToGeodetic(position)
  const angle = (value: number, [plus, minus]: string): string =>
    `${Math.abs(value).toFixed(3)}° ${value < 0 ? minus : plus}`
  return `${angle(latitude, 'NS')} ${angle(longitude, 'EW')}`
}
