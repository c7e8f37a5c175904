import { If, float, vec2, vec3, vec4 } from 'three/tsl'
import type { HeightSource, SurfacePoint } from '../../heights/HeightSource'
import { gradientAlong } from '../../surface/tsl/gradientAlong'
import { loop, type Float, type Vec2, type Vec3, type Vec4 } from '../../tsl-types'
import { AZIMUTHS, DISTANCES, FARTHER, FINENESS, NEAREST } from '../cpu/skyShare'

type Variable<T> = T & { addAssign(value: T): void; assign(value: T): void }

/**
 * Height of a place, and the share of the sky that the ground about it leaves free, relative to what its own slope leaves.
 *
 * Horizons at an angle e above the slope hide sin² e of a sky that is even, weighted by the cosine: in each azimuth the greatest of
 * rises over the slope, found at some distances at the detail that counts there.
 *
 * @param up - Geodetic up, ECEF axes.
 * @param shortest - See `HeightSource.sample`.
 * @returns Height [m] and share in (0, 1]. Twin: ../cpu/skyShare.ts
 */
export function heightAndSky(
  source: HeightSource,
  { reference, offset }: SurfacePoint,
  up: Vec3,
  shortest: Float
): Vec2 {
  // East, but for a place at the pole, where there is none.
  const eastward = vec3(0, 1e-4, 1).cross(up).toConst()
  const east = eastward.div(eastward.length().max(1e-6)).toConst()
  const north = up.cross(east).toConst()
  const ground = vec4(0).toVar() as unknown as Variable<Vec4>
  const rise = float(0).toVar() as unknown as Variable<Float>
  const sky = float(0).toVar() as unknown as Variable<Float>
  // The first is the place itself: a source's code is there once.
  loop('place', 1 + AZIMUTHS * DISTANCES, index => {
    const n = float(index).sub(1).toConst()
    const azimuth = n.add(0.5).div(DISTANCES).floor().toConst()
    const ring = n.sub(azimuth.mul(DISTANCES)).toConst()
    const angle = azimuth.mul((2 * Math.PI) / AZIMUTHS).toConst()
    const direction = east.mul(angle.sin()).add(north.mul(angle.cos())).toConst()
    const isHere = n.lessThan(0)
    const distance = isHere.select(0, float(FARTHER).pow(ring).mul(NEAREST)).toConst() as Float
    const place = offset.add(direction.mul(distance)).toConst() as Vec3
    const detail = shortest.max(distance.mul(FINENESS)).toConst() as Float
    const sampled = source.sample({ reference, offset: place }, detail).toConst() as Vec4
    If(isHere, () => {
      ground.assign(vec4(gradientAlong(sampled.xyz, up), sampled.w))
    }).Else(() => {
      const slope = sampled.w.sub(ground.w).div(distance).sub(ground.xyz.dot(direction))
      rise.assign(slope.max(ring.lessThan(0.5).select(0, rise) as unknown as Float))
      If(ring.greaterThan(DISTANCES - 1.5), () => {
        sky.addAssign(rise.mul(rise).add(1).reciprocal())
      })
    })
  })
  return vec2(ground.w, sky.div(AZIMUTHS))
}
