import { float, vec3 } from 'three/tsl'
import { CURL_CELLS, CURL_SCALE, noiseStatistics, seedOf, type NoiseChannel } from '../noiseRecipes'
import type { Float, Vec3 } from '../../tsl-types'
import { billow, perlin } from './noise'

const terms = { perlin, billow }

/** Φ(z) of the normal distribution, to 0.01. */
export const cumulative = (z: Float): Float => z.mul(-1.702).exp().add(1).reciprocal()

/**
 * One channel of a noise texture.
 *
 * @param index - Of the channel in its texture: sets the seeds.
 * @param p - Place in the texture, of period 1.
 * @returns In [0, 1]. Twin: test/twins/noise.ts
 */
export function channelNoise(channel: NoiseChannel, index: number, p: Vec3): Float {
  const { terms: parts, warp, encoding } = channel
  let place = p
  if (warp !== undefined) {
    const shift = (axis: number): Float =>
      perlin(p, vec3(warp.cells), float(seedOf(index, parts.length + axis)))
    place = p.add(vec3(shift(0), shift(1), shift(2)).mul(warp.amount)).toConst()
  }
  let variance = 0
  let sum: Float = float(0)
  parts.forEach(({ kind, cells, weight }, i) => {
    const [mean, deviation] = noiseStatistics[kind]
    variance += (weight * deviation) ** 2
    const noise = terms[kind](place, vec3(...cells), float(seedOf(index, i)))
    sum = sum.add(noise.sub(mean).mul(weight))
  })
  const z = sum.div(Math.sqrt(variance)).toConst() as Float
  if (encoding === 'normal') return z.mul(0.18).add(0.5).clamp(0, 1)
  return cumulative(z)
}

/**
 * Turbulence as the curl of three fields of Perlin noise, which has no sinks and no sources.
 *
 * @returns ½ + `CURL_SCALE` × curl, in [0, 1].
 * @see Bridson et al. 2007, "Curl-noise for procedural fluid flow", on potentials of noise. Twin: test/twins/noise.ts
 */
export function curlNoise(p: Vec3): Vec3 {
  const step = 0.02 / CURL_CELLS
  const axes = [vec3(step, 0, 0), vec3(0, step, 0), vec3(0, 0, step)]
  const slope = (component: number, axis: number): Float => {
    const at = (place: Vec3): Float => perlin(place, vec3(CURL_CELLS), float(3001 + 17 * component))
    return at(p.add(axes[axis]))
      .sub(at(p.sub(axes[axis])))
      .div(0.04)
  }
  const curl = (axis: number): Float => {
    const [next, last] = [(axis + 1) % 3, (axis + 2) % 3]
    return slope(last, next).sub(slope(next, last))
  }
  return vec3(curl(0), curl(1), curl(2)).mul(CURL_SCALE).add(0.5).clamp(0, 1)
}
