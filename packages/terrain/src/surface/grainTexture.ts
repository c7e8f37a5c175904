import { DataTexture, LinearFilter, LinearMipmapLinearFilter, RepeatWrapping } from 'three'

/** Side of the texture [texels]. */
const SIZE = 512

/** Largest slope that bytes can hold. */
export const GRAIN_SLOPE = 2

/** Height of stones that is 1 in blue [texels]. */
const STONE_HEIGHT = 12

/** Largest and smallest radius of stones [texels], and their number: of those that are larger than some size as its inverse square. */
const LARGEST = 30
const SMALLEST = 3
const STONES = 6500

/** Sides of a stone. */
const SIDES = 6

/** Blades of grass, and their lengths: the least, and the rest [texels]. */
const BLADES = 9000
const BLADE_LENGTH = [10, 26] as const

/** Repeatable random numbers in [0, 1). */
function randomNumbers(seed: number): () => number {
  let state = seed
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0
    return state / 2 ** 32
  }
}

/** Number of a texel on the plane that the picture repeats on. */
const texel = (x: number, y: number): number => (y & (SIZE - 1)) * SIZE + (x & (SIZE - 1))

/** Raises the ground to a stone: a block with slanting sides, under a tilted top. */
function addStone(heights: Float32Array, radius: number, random: () => number): void {
  const [x, y] = [random() * SIZE, random() * SIZE]
  const sides = Array.from({ length: SIDES }, (_, side) => {
    const turn = ((side + random()) * 2 * Math.PI) / SIDES
    const away = radius * (0.55 + 0.45 * random())
    const steepness = 0.7 + 0.9 * random()
    return { cosine: Math.cos(turn), sine: Math.sin(turn), away, steepness }
  })
  const lean = 2 * Math.PI * random()
  const tilt = 0.15 + 0.3 * random()
  const [tiltX, tiltY] = [tilt * Math.cos(lean), tilt * Math.sin(lean)]
  const top = radius * (0.25 + 0.35 * random())
  const reach = 1.2 * radius
  for (let j = Math.floor(y - reach); j <= y + reach; j++) {
    for (let i = Math.floor(x - reach); i <= x + reach; i++) {
      const [dx, dy] = [i - x, j - y]
      const n = texel(i, j)
      let height = top + dx * tiltX + dy * tiltY
      // Most texels are out of the first sides already.
      for (let side = 0; side < SIDES && height > heights[n]; side++) {
        const { cosine, sine, away, steepness } = sides[side]
        height = Math.min(height, (away - dx * cosine - dy * sine) * steepness)
      }
      heights[n] = Math.max(heights[n], height)
    }
  }
}

/** Lays a blade of grass over darker ones: a bent stroke, light at its tip. */
function addBlade(light: Float32Array, random: () => number): void {
  let [x, y] = [random() * SIZE, random() * SIZE]
  let turn = 2 * Math.PI * random()
  const bend = (random() - 0.5) * 0.12
  const brightness = random()
  const length = BLADE_LENGTH[0] + BLADE_LENGTH[1] * random()
  for (let step = 0; step < length; step++) {
    x += Math.cos(turn)
    y += Math.sin(turn)
    turn += bend
    const value = brightness * (0.45 + (0.55 * step) / length)
    const [i, j] = [Math.floor(x), Math.floor(y)]
    for (const n of [texel(i, j), texel(i + 1, j), texel(i, j + 1)]) {
      light[n] = Math.max(light[n], value)
    }
  }
}

/** Takes the mean off, so that levels of detail fade to 0. */
function center(values: Float32Array): Float32Array {
  const mean = values.reduce((sum, value) => sum + value, 0) / values.length
  return values.map(value => value - mean)
}

/**
 * Stones and grass as a picture that repeats, with 0 in the middle of a byte's range, to which its levels of detail fade: slope of
 * stones along both sides (red and green, of `GRAIN_SLOPE`), their height (blue), and light of blades (alpha).
 */
export function grainTexture(): DataTexture {
  const random = randomNumbers(311)
  const raised = new Float32Array(SIZE ** 2)
  for (let n = 0; n < STONES; n++) {
    // As many per size as there are of pieces when rock breaks: small ones fill the gaps.
    const share = random() * (1 / SMALLEST ** 2 - 1 / LARGEST ** 2) + 1 / LARGEST ** 2
    addStone(raised, share ** -0.5, random)
  }
  const light = new Float32Array(SIZE ** 2)
  for (let n = 0; n < BLADES; n++) addBlade(light, random)
  const stones = center(raised)
  const blades = center(light)
  // Rounds and clamps by itself.
  const bytes = new Uint8ClampedArray(4 * SIZE ** 2)
  const encode = (value: number, most: number): number => 127.5 + (127.5 * value) / most
  for (let n = 0; n < SIZE ** 2; n++) {
    const [x, y] = [n % SIZE, Math.floor(n / SIZE)]
    const rise = (i: number, j: number): number =>
      (stones[texel(x + i, y + j)] - stones[texel(x - i, y - j)]) / 2
    bytes[4 * n] = encode(rise(1, 0), GRAIN_SLOPE)
    bytes[4 * n + 1] = encode(rise(0, 1), GRAIN_SLOPE)
    bytes[4 * n + 2] = encode(stones[n], STONE_HEIGHT)
    bytes[4 * n + 3] = encode(blades[n], 1)
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
