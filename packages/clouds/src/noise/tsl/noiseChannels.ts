import { float, vec3 } from 'three/tsl'
import {
  ENCODING_SCALE,
  noiseDeviations,
  seedOf,
  shapeCurl,
  type NoiseChannel
} from '../noiseRecipes'
import type { Float, Vec2, Vec3 } from '../../tsl-types'
import { billow } from './billow'
import { curl, perlin } from './gradientNoise'

const terms = { perlin, billow }

/** Φ(z) of the normal distribution, to 0.01. */
export const cumulative = (z: Float): Float => z.mul(-1.702).exp().add(1).reciprocal()

/**
 * One channel of a noise texture.
 *
 * @param index - Index of the channel among all textures': sets the seeds.
 * @param p - Place in the texture, of period 1.
 * @returns In [0, 1]. Twin: test/twins/noise.ts
 */
export function channelNoise(channel: NoiseChannel, index: number, p: Vec3): Float {
  const { terms: parts, warp, encoding } = channel
  const [mean, deviation] = channel.statistics
  let point = p
  if (warp !== undefined) {
    const shift = (axis: number): Float =>
      perlin(p, vec3(warp.cells), float(seedOf(index, parts.length + axis)))
    point = p.add(vec3(shift(0), shift(1), shift(2)).mul(warp.amount)).toConst()
  }
  let sum: Float = float(-mean)
  parts.forEach(({ kind, cells, weight, stir }, i) => {
    if (stir !== undefined) {
      const shift = curl(p, float(stir.cells), float(seedOf(index, parts.length + i)))
      point = point.add(shift.mul(stir.amount / noiseDeviations.curl)).toConst()
    }
    sum = sum.add(terms[kind](point, vec3(...cells), float(seedOf(index, i))).mul(weight))
  })
  const z = sum.div(deviation).toConst() as Float
  if (encoding === 'uniform') return cumulative(z)
  return z.mul(ENCODING_SCALE).add(0.5).clamp()
}

/**
 * Turbulence: two components of a field without sinks and sources.
 *
 * @param index - Index of the first of its two channels.
 * @returns In [0, 1]. Twin: test/twins/noise.ts
 */
export function curlNoise(index: number, p: Vec3): Vec2 {
  const { cells, deviations } = shapeCurl
  const [perX, perY] = deviations.map(deviation => ENCODING_SCALE / deviation)
  const turbulence = curl(p, float(cells), float(seedOf(index, 0)))
  return turbulence
    .mul(vec3(perX, perY, 0))
    .add(0.5)
    .clamp().xy
}
