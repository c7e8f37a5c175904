import { RedFormat, type DataTexture } from 'three'
import { texture } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { tileable } from '../mipmapped'
import { latticeHash, octaves, OCTAVES_SIDE } from '../octaves'

function valueNoise(x: number, y: number, period: number): number {
  const x0 = Math.floor(x)
  const y0 = Math.floor(y)
  const u = (x - x0) ** 2 * (3 - 2 * (x - x0))
  const v = (y - y0) ** 2 * (3 - 2 * (y - y0))
  const random = (i: number, j: number): number => latticeHash(x0 + i, y0 + j, period)
  const top = random(0, 0) * (1 - u) + random(1, 0) * u
  const bottom = random(0, 1) * (1 - u) + random(1, 1) * u
  return top * (1 - v) + bottom * v
}

/** A tileable texture of five octaves of noise about 0.5, the same on every run. */
export function createNoiseTexture(): DataTexture {
  const bytes = octaves((x, y, period) => valueNoise(x, y, period) - 0.5, 140)
  const result = tileable(bytes, OCTAVES_SIDE, RedFormat)
  result.anisotropy = 4
  return result
}

/**
 * Relative brightness about 1 of ground seen at any distance.
 *
 * The same noise at four scales; mipmaps level each one out where it is too fine to see.
 *
 * @param coordinates - Periods of the coarsest scale.
 */
export function groundDetail(noise: DataTexture, coordinates: Node<'vec2'>): Node<'float'> {
  const octave = (scale: number): Node<'float'> => texture(noise, coordinates.mul(scale)).r.sub(0.5)
  // Whole numbers: tiles shift their coordinates by whole periods.
  const sum = octave(1).add(octave(9)).add(octave(83)).add(octave(611))
  return sum.mul(0.45).add(1)
}
