import { expect, it } from 'vitest'
import { Picture } from '../gpu/harness/picture'
import { trailOf } from '../gpu/harness/trails'

const [width, height] = [64, 4]

/** Soft stripes, moved by some pixels. */
const stripes = (offset: number): Picture => {
  const data = new Float32Array(4 * width * height)
  data.forEach((_, i) => {
    const x = ((i >> 2) % width) - offset
    data[i] = i % 4 === 3 ? 1 : (0.5 + 0.2 * Math.sin(x / 2) + 0.1 * Math.sin(x / 5)) ** 2.2
  })
  return new Picture(width, height, data)
}

const mix = (a: Picture, b: Picture, share: number): Picture =>
  new Picture(
    width,
    height,
    a.data.map((value, i) => {
      const [x, y] = [value, b.data[i]].map(light => light ** (1 / 2.2))
      return (x + (y - x) * share) ** 2.2
    })
  )

const exact = stripes(9)
const [earlier, later] = [stripes(6), stripes(12)]

it('finds what is left of an earlier picture, and nothing where none is', () => {
  const trail = (drawn: Picture): number => trailOf(drawn, exact, earlier, later)
  expect(trail(exact)).toBe(0)
  expect(trail(mix(exact, earlier, 0.2))).toBeGreaterThan(0.2)
  expect(trail(mix(exact, earlier, 0.2))).toBeLessThan(0.45)
  expect(trail(mix(exact, stripes(8), 0.3))).toBeGreaterThan(0.05)
  // Blur goes both ways.
  const blurred = mix(mix(exact, earlier, 0.2), mix(exact, later, 0.2), 0.5)
  expect(Math.abs(trail(blurred))).toBeLessThan(0.01)
})
