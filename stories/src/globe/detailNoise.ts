import {
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  RedFormat,
  RepeatWrapping,
  UnsignedByteType
} from 'three'
import { texture } from 'three/tsl'
import type { Node } from 'three/webgpu'

const SIZE = 256

function hash(x: number, y: number, period: number): number {
  let bits =
    Math.imul((x + period) % period, 0x27d4eb2d) ^ Math.imul((y + period) % period, 0x165667b1)
  bits = Math.imul(bits ^ (bits >>> 15) ^ period, 0x2c1b3c6d)
  bits = Math.imul(bits ^ (bits >>> 12), 0x297a2d39)
  return ((bits ^ (bits >>> 15)) >>> 0) / 4294967296
}

function valueNoise(x: number, y: number, period: number): number {
  const x0 = Math.floor(x)
  const y0 = Math.floor(y)
  const u = (x - x0) ** 2 * (3 - 2 * (x - x0))
  const v = (y - y0) ** 2 * (3 - 2 * (y - y0))
  const top = hash(x0, y0, period) * (1 - u) + hash(x0 + 1, y0, period) * u
  const bottom = hash(x0, y0 + 1, period) * (1 - u) + hash(x0 + 1, y0 + 1, period) * u
  return top * (1 - v) + bottom * v
}

/** A tileable texture of five octaves of noise about 0.5, the same on every run. */
export function createNoiseTexture(): DataTexture {
  const data = new Uint8Array(SIZE * SIZE)
  for (let y = 0; y < SIZE; y++) {
    for (let x = 0; x < SIZE; x++) {
      let sum = 0
      for (let octave = 0; octave < 5; octave++) {
        const period = 8 * 2 ** octave
        sum += (valueNoise((x / SIZE) * period, (y / SIZE) * period, period) - 0.5) / 2 ** octave
      }
      data[y * SIZE + x] = Math.min(Math.max(127.5 + sum * 140, 0), 255)
    }
  }
  const result = new DataTexture(data, SIZE, SIZE, RedFormat, UnsignedByteType)
  result.wrapS = result.wrapT = RepeatWrapping
  result.magFilter = LinearFilter
  result.minFilter = LinearMipmapLinearFilter
  result.generateMipmaps = true
  result.anisotropy = 4
  result.needsUpdate = true
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
