import {
  FIRST_CHANNEL,
  detailChannel,
  shapeChannels,
  weatherChannels,
  type NoiseChannel
} from '../../src/noise/noiseRecipes'
import { NOISE_SIZE, type NoiseName } from '../../src/noise/noiseSizes'
import { channelNoise, curlNoise, type Vec3Array } from './noise'

const channelsAt = (channels: readonly NoiseChannel[], first: number, p: Vec3Array): number[] =>
  channels.map((channel, i) => channelNoise(channel, first + i, p))

const contents: Record<NoiseName, (p: Vec3Array) => number[]> = {
  shape: p => [
    ...channelsAt(shapeChannels, FIRST_CHANNEL.shape, p),
    ...curlNoise(FIRST_CHANNEL.shape + shapeChannels.length, p)
  ],
  detail: p => channelsAt([detailChannel], FIRST_CHANNEL.detail, p),
  weather: p => channelsAt(weatherChannels, FIRST_CHANNEL.weather, p)
}

const mixed = (a: number[], b: number[], t: number): number[] =>
  a.map((value, i) => value + (b[i] - value) * t)

/** Texels of all {@link NoiseTextures}, by texture and level, and by their place in it. */
const _texels = new Map<string, Map<number, number[]>>()

function texelsOf(name: NoiseName, level: number): Map<number, number[]> {
  const key = `${name} ${level}`
  const kept = _texels.get(key) ?? new Map<number, number[]>()
  _texels.set(key, kept)
  return kept
}

/**
 * Float64 twin of the noise textures, read as the GPU reads them. Texels are computed when they are
 * first needed and kept: a whole texture would take minutes.
 */
export class NoiseTextures {
  /** Texel of a level as the GPU stores it: bytes, as numbers in [0, 1]. */
  texel(name: NoiseName, index: Vec3Array, level = 0): number[] {
    const size = NOISE_SIZE[name] >> level
    const place = index.map(i => ((i % size) + size) % size) as [number, number, number]
    const [x, y, z] = place
    const key = (z * size + y) * size + x
    const texels = texelsOf(name, level)
    let texel = texels.get(key)
    if (texel === undefined) {
      texel = this.#compute(name, place, level).map(x => Math.round(x * 255) / 255)
      texels.set(key, texel)
    }
    return texel
  }

  #compute(name: NoiseName, place: Vec3Array, level: number): number[] {
    if (level === 0) {
      const [x, y, z] = place.map(i => (i + 0.5) / NOISE_SIZE[name])
      return contents[name]([x, y, z])
    }
    const finer = [0, 1, 2, 3, 4, 5, 6, 7].map(corner => {
      const [i, j, k] = place.map((n, axis) => 2 * n + ((corner >> axis) & 1))
      return this.texel(name, [i, j, k], level - 1)
    })
    return finer[0].map((_, channel) => finer.reduce((sum, texel) => sum + texel[channel] / 8, 0))
  }

  /**
   * Trilinear look-up, and linear between levels.
   *
   * @param p - In periods.
   * @param level - Level of detail, at least 0.
   */
  sample(name: NoiseName, p: Vec3Array, level: number): number[] {
    const coarsest = Math.log2(NOISE_SIZE[name])
    const clamped = Math.min(Math.max(level, 0), coarsest)
    const low = Math.floor(clamped)
    const fine = this.#sampleLevel(name, p, low)
    if (clamped === low) return fine
    return mixed(fine, this.#sampleLevel(name, p, low + 1), clamped - low)
  }

  #sampleLevel(name: NoiseName, p: Vec3Array, level: number): number[] {
    const size = NOISE_SIZE[name] >> level
    const place = p.map(x => x * size - 0.5)
    const base = place.map(Math.floor)
    const [tx, ty, tz] = place.map((x, axis) => x - base[axis])
    const corner = (i: number, j: number, k: number): number[] =>
      this.texel(name, [base[0] + i, base[1] + j, base[2] + k], level)
    const row = (j: number, k: number): number[] => mixed(corner(0, j, k), corner(1, j, k), tx)
    const sheet = (k: number): number[] => mixed(row(0, k), row(1, k), ty)
    return mixed(sheet(0), sheet(1), tz)
  }
}
