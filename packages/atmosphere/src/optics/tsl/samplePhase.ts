import { acos, vec2 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { HALF_TEXELS } from '../cpu/phaseRow'
import { sampleLevel0, type Float, type Vec4 } from '../../tsl-types'

/**
 * Phase function from a row of a texture [1/sr]. Twin: `phaseRow`
 *
 * @param cosScatter - Cosine of the scattering angle, in [−1, 1].
 * @param v - Texture coordinate of the row.
 */
export function samplePhase(table: TextureNode, cosScatter: Float, v: Float | number): Vec4 {
  const angle = acos(cosScatter.abs().min(1)) as Float
  const place = angle
    .mul(2 / Math.PI)
    .sqrt()
    .mul((HALF_TEXELS - 1) / (2 * HALF_TEXELS))
    .add(0.25 / HALF_TEXELS)
    .toConst() as Float
  const u = cosScatter.lessThan(0).select(place.oneMinus(), place)
  return sampleLevel0(table, vec2(u as Float, v))
}
