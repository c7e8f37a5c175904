import { atan, fract, log2, mix, vec2 } from 'three/tsl'
import { select } from '../../select'
import type { Float, Int, LevelTexture, Vec2, Vec3 } from '../../tsl-types'

/** The planet, as a look-up of its map needs it: a `CloudField`. */
export interface MappedPlanet {
  /** Radius of the mapped space's sphere [m]. */
  readonly radius: Float
  /** Axial ratio a/b of the ellipsoid. */
  readonly axialRatio: number
}

/** A layer, as a look-up of a map needs it. */
export interface MappedLayer {
  readonly index: Int
  readonly coverage: Float
}

/** An equirectangular map of the share of the sky that is covered. */
export interface CoverMap {
  readonly texture: LevelTexture<Vec2>
  /** True if it ends at its edges, false if it is repeated beyond them. */
  readonly isPlaced: boolean
  /** True if it has a channel for each layer. */
  readonly perLayer: boolean
  /** Longitude and latitude of its south-west corner [rad]. */
  readonly corner: Vec2
  /** Extent east and north [rad]. */
  readonly size: Vec2
  /** Extent of a texel [rad]. */
  readonly texel: Vec2
  /** `mapShift` [rad]. */
  readonly shift: Float
}

/** Share of the width of a placed map over which it fades in at its edges. 0: weather ends in straight walls. No story
 * has such a map: see it with `bounds` in *World clouds*. */
const EDGE = 0.05

/** Place in a map, from 0 to 1 between its edges, in the direction of `up`; and the extent of a texel there [m]. */
function placeIn(
  map: CoverMap,
  { axialRatio, radius }: MappedPlanet,
  up: Vec3
): { uv: Vec2; texel: Float } {
  const across = up.xy.length().max(1e-6).toConst() as Float
  const longitude = atan(
    up.y,
    up.x
      .abs()
      .max(1e-9)
      .mul(select(up.x.lessThan(0), -1, 1))
  )
  // Geodetic, from the latitude on the sphere.
  const latitude = atan(up.z.mul(axialRatio), across)
  const east = fract(longitude.sub(map.corner.x).div(2 * Math.PI)).mul(2 * Math.PI)
  const uv = vec2(east, latitude.sub(map.corner.y)).div(map.size).toConst() as Vec2
  // Meridians meet at the poles: a texel there is narrower.
  const texel = across.mul(map.texel.x).min(map.texel.y).mul(radius)
  return { uv, texel }
}

/**
 * Share of the sky that a layer covers around a place: its coverage, and that of a map.
 *
 * @param up - Zenith there.
 * @param fields - Noise that shifts the look-up of the map, of which it hides the shapes of texels from near; it is
 *   gone where fields are too small to be seen.
 * @returns In [0, 1].
 */
export function mappedCoverage(
  map: CoverMap,
  planet: MappedPlanet,
  { index, coverage }: MappedLayer,
  up: Vec3,
  footprint: Float,
  fields: Vec3
): Float {
  const { uv, texel } = placeIn(map, planet, up.add(fields.mul(map.shift)).toConst())
  const shares = map.texture.sample(uv).level(log2(footprint.div(texel).max(1)))
  const [first, second, third, fourth] = [shares.x, shares.y, shares.z, shares.w]
  const share = (
    map.perLayer
      ? select(
          index.lessThan(2),
          select(index.equal(0), first, second),
          select(index.equal(2), third, fourth)
        )
      : first
  )
    .clamp()
    .toConst() as Float
  // Odds multiply: 0 and 1 stay, and a coverage of ½ leaves the map as it is.
  const covered = share.mul(coverage).toConst() as Float
  const clear = share.oneMinus().mul(coverage.oneMinus())
  const mapped = covered.div(covered.add(clear).max(1e-6)).toConst() as Float
  if (!map.isPlaced) return mapped
  const within = uv.min(uv.oneMinus()).div(EDGE).clamp().toConst() as Vec2
  return mix(coverage, mapped, within.x.mul(within.y)).toConst()
}
