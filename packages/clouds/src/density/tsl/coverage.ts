import { atan, log2, vec2 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { mapShift } from '../../layers/layerUniforms'
import type { Float, LevelTexture, Vec2, Vec3 } from '../../tsl-types'
import type { LayerNodes } from './layer'
import type { CloudSample } from './sample'

/** Share of the sky that the world map has covered around a place, in the direction of `up`. */
function mappedCoverage(
  field: CloudField,
  worldMap: LevelTexture<Vec2>,
  up: Vec3,
  footprint: Float
): Float {
  const across = up.xy.length().max(1e-6).toConst() as Float
  const longitude = atan(up.y, up.x.abs().max(1e-9).mul(up.x.lessThan(0).select(-1, 1)))
  // Geodetic, from the latitude on the sphere.
  const latitude = atan(up.z.mul(field.axialRatio), across)
  const uv = vec2(longitude.div(2 * Math.PI), latitude.div(Math.PI)).add(0.5)
  // Meridians meet at the poles: a texel there is narrower.
  const texel = field.radius.mul(across).mul((2 * Math.PI) / field.worldMapWidth)
  return worldMap.sample(uv).level(log2(footprint.div(texel).max(1))).x
}

/**
 * Share of the sky that a layer covers around a place, as far as it is known without noise: the layer's
 * coverage, and that of the world map if there is one.
 *
 * @param shift - Shifts the look-up of the map, by the fields of the weather: it hides the shapes of the
 *   map's texels from near, and is gone where fields are too small to be seen.
 * @returns In [0, 1].
 */
export function coverageAt(
  field: CloudField,
  layer: LayerNodes,
  { up }: Pick<CloudSample, 'up'>,
  footprint: Float,
  shift: Vec3
): Float {
  if (field.worldMap === null) return layer.coverage
  const there = up.add(shift.mul(mapShift(field.worldMapWidth))).toConst() as Vec3
  const share = mappedCoverage(field, field.worldMap, there, footprint)
    .clamp(0, 1)
    .toConst() as Float
  // Odds multiply: 0 and 1 stay, and a coverage of ½ leaves the map as it is.
  const covered = share.mul(layer.coverage).toConst() as Float
  const clear = share.oneMinus().mul(layer.coverage.oneMinus())
  return covered.div(covered.add(clear).max(1e-6)).toConst()
}
