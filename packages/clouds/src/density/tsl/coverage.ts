import { atan, log2, vec2 } from 'three/tsl'
import { mapShift } from '../../layers/layerUniforms'
import type { Float, LevelTexture, Vec2, Vec3 } from '../../tsl-types'

/** The planet, as a look-up of its map needs it: a `CloudField`. */
export interface MappedPlanet {
  /** Radius of the mapped space's sphere [m]. */
  readonly radius: Float
  /** Axial ratio a/b of the ellipsoid. */
  readonly axialRatio: number
}

/** Share of the sky that a world map has covered around a place, in the direction of `up`. */
function shareAt(
  map: LevelTexture<Vec2>,
  width: number,
  { axialRatio, radius }: MappedPlanet,
  up: Vec3,
  footprint: Float
): Float {
  const across = up.xy.length().max(1e-6).toConst() as Float
  const longitude = atan(up.y, up.x.abs().max(1e-9).mul(up.x.lessThan(0).select(-1, 1)))
  // Geodetic, from the latitude on the sphere.
  const latitude = atan(up.z.mul(axialRatio), across)
  const uv = vec2(longitude.div(2 * Math.PI), latitude.div(Math.PI)).add(0.5)
  // Meridians meet at the poles: a texel there is narrower.
  const texel = radius.mul(across).mul((2 * Math.PI) / width)
  return map.sample(uv).level(log2(footprint.div(texel).max(1))).x
}

/**
 * Share of the sky that a layer covers around a place: its coverage, and that of the world map.
 *
 * @param width - Width of the map [texels].
 * @param coverage - The layer's.
 * @param up - Zenith there.
 * @param shift - Shifts the look-up of the map, by the fields of the weather: it hides the shapes of the
 *   map's texels from near, and is gone where fields are too small to be seen.
 * @returns In [0, 1].
 */
export function mappedCoverage(
  map: LevelTexture<Vec2>,
  width: number,
  planet: MappedPlanet,
  coverage: Float,
  up: Vec3,
  footprint: Float,
  shift: Vec3
): Float {
  const there = up.add(shift.mul(mapShift(width))).toConst() as Vec3
  const share = shareAt(map, width, planet, there, footprint).clamp(0, 1).toConst() as Float
  // Odds multiply: 0 and 1 stay, and a coverage of ½ leaves the map as it is.
  const covered = share.mul(coverage).toConst() as Float
  const clear = share.oneMinus().mul(coverage.oneMinus())
  return covered.div(covered.add(clear).max(1e-6)).toConst()
}
