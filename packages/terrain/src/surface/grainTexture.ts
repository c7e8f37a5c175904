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

/** Tufts of grass and blades of each, their lengths [texels], and half of their width at the root [texels]. */
const TUFTS = 520
const BLADES = 17
const SHORTEST_BLADE = 8
const LONGER_BLADE = 34
const BLADE_WIDTH = 1.55

/** Distance between the spots that a blade is made of [texels]. */
const STEP = 1.2

/** Mean distance of a blade's root from its tuft [texels]. */
const TUFT_RADIUS = 15

/** Part of the blades that is dry, and light of those: greater than of any green one. */
const DRY_BLADES = 0.09
const DRY_LIGHT = 0.92

/** Difference of light from its mean that is 1 in alpha. */
const BLADE_CONTRAST = 0.6

/** Tufts to a plant with three round leaves, and the radius of a leaf [texels]. */
const TUFTS_TO_HERB = 3
const SMALLEST_LEAF = 1.4
const LARGER_LEAF = 1.8

/** Repeatable random numbers in [0, 1). */
function randomNumbers(seed: number): () => number {
  let state = seed
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0
    return state / 2 ** 32
  }
}

/** Number of the first texel of a row; rows repeat. */
const rowAt = (y: number): number => (y & (SIZE - 1)) * SIZE
/** Column of a texel; columns repeat. */
const wrapped = (x: number): number => x & (SIZE - 1)

/** Sides of a stone, and its top, as planes: height in the middle, and slopes along x and y. */
const planes = new Float64Array(3 * (SIDES + 1))

/** Raises the ground to a stone: a block with slanting sides, under a tilted top. */
function addStone(heights: Float32Array, radius: number, random: () => number): void {
  const [x, y] = [random() * SIZE, random() * SIZE]
  for (let side = 0; side < SIDES; side++) {
    const turn = ((side + random()) * 2 * Math.PI) / SIDES
    const away = radius * (0.55 + 0.45 * random())
    const steepness = 0.7 + 0.9 * random()
    planes[3 * side] = away * steepness
    planes[3 * side + 1] = -Math.cos(turn) * steepness
    planes[3 * side + 2] = -Math.sin(turn) * steepness
  }
  const lean = 2 * Math.PI * random()
  const tilt = 0.15 + 0.3 * random()
  planes[3 * SIDES] = radius * (0.25 + 0.35 * random())
  planes[3 * SIDES + 1] = tilt * Math.cos(lean)
  planes[3 * SIDES + 2] = tilt * Math.sin(lean)
  const reach = 1.2 * radius
  for (let j = Math.floor(y - reach); j <= y + reach; j++) {
    const row = rowAt(j)
    for (let i = Math.floor(x - reach); i <= x + reach; i++) {
      const at = row + wrapped(i)
      let height = Infinity
      // Most texels are out of the first sides already.
      for (let n = 0; n < planes.length && height > heights[at]; n += 3) {
        const plane = planes[n] + (i - x) * planes[n + 1] + (j - y) * planes[n + 2]
        if (plane < height) height = plane
      }
      if (height > heights[at]) heights[at] = height
    }
  }
}

/** Lays a round spot over what is there: soft at its edge, with a shadow about it. */
function addSpot(light: Float32Array, x: number, y: number, radius: number, value: number): void {
  const reach = radius + 1.5
  for (let j = Math.ceil(y - reach); j <= y + reach; j++) {
    const row = rowAt(j)
    const away = (j - y) ** 2
    const half = Math.sqrt(reach ** 2 - away)
    for (let i = Math.ceil(x - half); i <= x + half; i++) {
      const n = row + wrapped(i)
      const inside = radius - Math.sqrt((i - x) ** 2 + away)
      const cover = Math.min(Math.max(inside + 0.5, 0), 1)
      const shade = Math.min(inside + 1.5, 1) * (1 - cover)
      light[n] = light[n] * (1 - 0.3 * shade) * (1 - cover) + value * cover
    }
  }
}

/** Lays a blade of grass over what is there: bent, pointed, dark at its root. */
function addBlade(
  light: Float32Array,
  [x, y]: [number, number],
  turn: number,
  random: () => number
): void {
  const length = SHORTEST_BLADE + LONGER_BLADE * random() ** 2
  const bend = (random() - 0.5) * (1.8 / length)
  const width = BLADE_WIDTH * (0.5 + 0.6 * random())
  const brightness = random() < DRY_BLADES ? DRY_LIGHT : 0.42 + 0.3 * random()
  for (let step = 0; step < length; step += STEP) {
    const part = step / length
    addSpot(light, x, y, width * (1 - part ** 2), brightness * (0.62 + 0.38 * part))
    x += STEP * Math.cos(turn)
    y += STEP * Math.sin(turn)
    turn += STEP * bend
  }
}

/** Soil, tufts of grass about their middles, and leaves of herbs, as light. */
function grass(random: () => number): Float32Array {
  const light = new Float32Array(SIZE ** 2)
  for (let n = 0; n < light.length; n++) light[n] = 0.1 + 0.14 * random()
  for (let n = 0; n < TUFTS; n++) {
    const [x, y] = [random() * SIZE, random() * SIZE]
    const lean = 2 * Math.PI * random()
    for (let blade = 0; blade < BLADES; blade++) {
      // Outward from the middle, and all a little to one side.
      const away = 2 * Math.PI * random()
      const distance = TUFT_RADIUS * random() ** 0.7
      const root: [number, number] = [x + distance * Math.cos(away), y + distance * Math.sin(away)]
      const turn = Math.atan2(
        Math.sin(away) + 0.7 * Math.sin(lean),
        Math.cos(away) + 0.7 * Math.cos(lean)
      )
      addBlade(light, root, turn + 0.8 * (random() - 0.5), random)
    }
    if (n % TUFTS_TO_HERB === 0) addHerb(light, random)
  }
  return light
}

/** Lays a plant with three round leaves over what is there. */
function addHerb(light: Float32Array, random: () => number): void {
  const [x, y] = [random() * SIZE, random() * SIZE]
  const radius = SMALLEST_LEAF + LARGER_LEAF * random()
  const turn = 2 * Math.PI * random()
  const value = 0.36 + 0.14 * random()
  for (let leaf = 0; leaf < 3; leaf++) {
    const angle = turn + (leaf * 2 * Math.PI) / 3
    const [i, j] = [x + 1.1 * radius * Math.cos(angle), y + 1.1 * radius * Math.sin(angle)]
    addSpot(light, i, j, radius, value)
  }
}

/** Mean, which is taken off so that levels of detail fade to 0. */
function meanOf(values: Float32Array): number {
  let sum = 0
  for (let n = 0; n < values.length; n++) sum += values[n]
  return sum / values.length
}

/**
 * Stones and grass as a picture that repeats, with 0 in the middle of a byte's range, to which its levels of detail fade: slope of
 * stones along both sides (red and green, of `GRAIN_SLOPE`), their height (blue), and light of blades (alpha).
 */
export function grainTexture(): DataTexture {
  const random = randomNumbers(311)
  const stones = new Float32Array(SIZE ** 2)
  for (let n = 0; n < STONES; n++) {
    // As many per size as there are of pieces when rock breaks: small ones fill the gaps.
    const share = random() * (1 / SMALLEST ** 2 - 1 / LARGEST ** 2) + 1 / LARGEST ** 2
    addStone(stones, share ** -0.5, random)
  }
  const blades = grass(random)
  const [level, mean] = [meanOf(stones), meanOf(blades)]
  // Rounds and clamps by itself.
  const bytes = new Uint8ClampedArray(4 * SIZE ** 2)
  for (let y = 0; y < SIZE; y++) {
    const [above, row, below] = [rowAt(y - 1), rowAt(y), rowAt(y + 1)]
    for (let x = 0; x < SIZE; x++) {
      const n = row + x
      const across = stones[row + wrapped(x + 1)] - stones[row + wrapped(x - 1)]
      const along = stones[below + x] - stones[above + x]
      bytes[4 * n] = 127.5 * (1 + across / (2 * GRAIN_SLOPE))
      bytes[4 * n + 1] = 127.5 * (1 + along / (2 * GRAIN_SLOPE))
      bytes[4 * n + 2] = 127.5 * (1 + (stones[n] - level) / STONE_HEIGHT)
      bytes[4 * n + 3] = 127.5 * (1 + (blades[n] - mean) / BLADE_CONTRAST)
    }
  }
  const texture = new DataTexture(bytes, SIZE, SIZE)
  texture.name = 'Welkin.Terrain.grain'
  texture.wrapS = texture.wrapT = RepeatWrapping
  texture.minFilter = LinearMipmapLinearFilter
  texture.magFilter = LinearFilter
  texture.generateMipmaps = true
  texture.needsUpdate = true
  return texture
}
