import { DataTexture, LinearFilter, LinearMipmapLinearFilter, RepeatWrapping } from 'three'

/** Side of the texture [texels]. */
const SIZE = 256

/** Waves of the longest octave along a side. */
export const GRAIN_WAVES = 8

const OCTAVES = 4

/** Amplitude of an octave per that of the one before. */
const GAIN = 0.62

/** Largest value and slope per wave that bytes can hold. */
export const GRAIN_VALUE = 1.5
export const GRAIN_SLOPE = 8

/** Adds gradient noise with so many waves along a side, which repeats. */
function addNoise(values: Float32Array, waves: number, amplitude: number, seed: number): void {
  let state = seed
  const turns = Float32Array.from({ length: waves ** 2 }, () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0
    return (state / 2 ** 32) * 2 * Math.PI
  })
  const [cosines, sines] = [turns.map(Math.cos), turns.map(Math.sin)]
  const blend = (t: number): number => t ** 3 * (t * (t * 6 - 15) + 10)
  for (let row = 0; row < SIZE; row++) {
    const y = ((row + 0.5) * waves) / SIZE
    const j = Math.floor(y)
    for (let column = 0; column < SIZE; column++) {
      const x = ((column + 0.5) * waves) / SIZE
      const i = Math.floor(x)
      const corner = (a: number, b: number): number => {
        const n = ((j + b) % waves) * waves + ((i + a) % waves)
        return cosines[n] * (x - i - a) + sines[n] * (y - j - b)
      }
      const across = blend(x - i)
      const lower = corner(0, 0) + across * (corner(1, 0) - corner(0, 0))
      const upper = corner(0, 1) + across * (corner(1, 1) - corner(0, 1))
      values[row * SIZE + column] += amplitude * (lower + blend(y - j) * (upper - lower))
    }
  }
}

/**
 * Stones and tufts as a picture that repeats: slope along both sides per wave of the longest octave (red and green, of
 * `GRAIN_SLOPE`) and value (blue, of `GRAIN_VALUE`), 0 in the middle of a byte's range. Its levels of detail fade to 0.
 */
export function grainTexture(): DataTexture {
  const values = new Float32Array(SIZE ** 2)
  for (let octave = 0; octave < OCTAVES; octave++) {
    addNoise(values, GRAIN_WAVES << octave, GAIN ** octave, 311 + octave)
  }
  const at = (x: number, y: number): number => values[(y & (SIZE - 1)) * SIZE + (x & (SIZE - 1))]
  const bytes = new Uint8Array(4 * SIZE ** 2)
  const encode = (value: number, most: number): number =>
    Math.round(127.5 + 127.5 * Math.min(Math.max(value / most, -1), 1))
  // Of central differences: texels per wave, over two texels.
  const perWave = SIZE / GRAIN_WAVES / 2
  for (let n = 0; n < SIZE ** 2; n++) {
    const [x, y] = [n % SIZE, Math.floor(n / SIZE)]
    bytes[4 * n] = encode((at(x + 1, y) - at(x - 1, y)) * perWave, GRAIN_SLOPE)
    bytes[4 * n + 1] = encode((at(x, y + 1) - at(x, y - 1)) * perWave, GRAIN_SLOPE)
    bytes[4 * n + 2] = encode(values[n], GRAIN_VALUE)
    bytes[4 * n + 3] = 255
  }
  const texture = new DataTexture(bytes, SIZE, SIZE)
  texture.name = 'Welkin.Terrain.grain'
  texture.wrapS = texture.wrapT = RepeatWrapping
  texture.minFilter = LinearMipmapLinearFilter
  texture.magFilter = LinearFilter
  texture.anisotropy = 4
  texture.generateMipmaps = true
  texture.needsUpdate = true
  return texture
}
