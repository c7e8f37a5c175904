import { expect, it } from 'vitest'
import { GOLDEN_RATIO, pixelAt } from '../../src/march/FrameUniforms'
import { sharedWeights } from '../twins/rayWeights'

const fract = (x: number): number => x - Math.floor(x)

/** Float64 code of `interleavedNoise`. */
const noiseAt = (x: number, y: number, shift: number): number =>
  fract(fract(0.06711056 * x + 0.00583715 * y) * 52.9829189 + shift)

/** Bilinear weights, of the two rays around a place along an axis. */
const bilinear = (place: number): Map<number, number> => {
  const first = Math.floor(place)
  return new Map([
    [first, first + 1 - place],
    [first + 1, place - first]
  ])
}

/** Frames of a picture, and marched pixels of each along an edge. */
const FRAMES = 128
const MARCHED = 20

/**
 * Difference from pixel to pixel, root mean square, in a picture that stands still, marched in blocks of 4 × 4 of which four share a ray of what falls.
 *
 * @param errorOf - Error of a ray, by the place of samples in its steps, in [0, 1).
 */
function grainOf(
  weightsOf: (place: number) => Map<number, number>,
  errorOf: (jitter: number) => number
): number {
  const size = 4 * MARCHED
  const sums = new Float64Array(size * size)
  for (let frame = 0; frame < FRAMES; frame++) {
    const index = pixelAt(4, frame)
    const round = Math.floor(frame / 16)
    const shift = round * GOLDEN_RATIO + index / 16
    const own = pixelAt(2, round)
    const [across, down] = [own & 1, own >> 1].map(first =>
      Array.from({ length: MARCHED }, (_, i) => [...weightsOf((i - first - 0.5) / 2)])
    )
    down.forEach((rows, j) => {
      across.forEach((columns, i) => {
        const pixel = (4 * j + (index >> 2)) * size + 4 * i + (index % 4)
        for (const [y, b] of rows) {
          for (const [x, a] of columns)
            sums[pixel] += a * b * errorOf(noiseAt(x + 50, y + 70, shift))
        }
      })
    })
  }
  let squares = 0
  for (let i = 1; i < sums.length; i++) {
    if (i % size > 0) squares += (sums[i] - sums[i - 1]) ** 2
  }
  return Math.sqrt(squares / size / (size - 1)) / (FRAMES / 16)
}

it('has at most three fifths of the grain of bilinear weights', () => {
  for (const errorOf of [
    (jitter: number) => jitter,
    (jitter: number) => (jitter < 0.3 ? 1 : 0),
    (jitter: number) => Math.sin(2 * Math.PI * jitter),
    (jitter: number) => Math.sin(4 * Math.PI * jitter)
  ]) {
    const grain = grainOf(bilinear, errorOf)
    expect(grain).toBeGreaterThan(0.01)
    expect(grainOf(sharedWeights, errorOf)).toBeLessThan(0.6 * grain)
  }
})

it('keeps light that is even, or grows evenly', () => {
  for (let place = -2; place < 3; place += 0.0625) {
    const weights = [...sharedWeights(place)]
    expect(weights.reduce((sum, [, weight]) => sum + weight, 0)).toBeCloseTo(1, 12)
    expect(weights.reduce((sum, [ray, weight]) => sum + ray * weight, 0)).toBeCloseTo(place, 12)
  }
})
