import { expect, it } from 'vitest'
import { expectLit } from '../gpu/harness/lit-picture'
import { Picture } from '../gpu/harness/picture'

const [width, height] = [32, 18]

/** A picture of daylight, of one colour here and another there. */
function picture(change: (x: number, y: number, channel: number) => number | null): Picture {
  const data = new Float32Array(4 * width * height)
  data.forEach((_, i) => {
    const [x, y] = [(i >> 2) % width, Math.floor((i >> 2) / width)]
    data[i] = change(x, y, i % 4) ?? (i % 4 === 3 ? 1 : 0.05 + 0.4 * (x / width))
  })
  return new Picture(width, height, data)
}

type Test = (x: number, y: number) => boolean
const all: Test = () => true
const check = (drawn: Picture, must = all) => expectLit(drawn, must, 'a picture')

it('passes a picture that has light everywhere', () => {
  const { median, least } = check(picture(() => null))
  expect(least).toBeCloseTo(0.05, 6)
  expect(median).toBeGreaterThan(0.2)
})

const black = (inside: (x: number, y: number) => boolean, value = 0) =>
  picture((x, y, channel) => (channel < 3 && inside(x, y) ? value : null))

it.each([
  ['all of it', all],
  ['the left half', (x: number) => x < width / 2],
  ['the upper half', (_: number, y: number) => y < height / 2],
  ['nine tenths', (x: number, y: number) => (x + y) % 10 > 0],
  ['a pixel', (x: number, y: number) => x === 7 && y === 5]
] as const)('fails when %s is black, or as good as black', (_, inside) => {
  expect(() => check(black(inside))).toThrow(/pixel \(/)
  if (inside !== all) expect(() => check(black(inside, 1e-5))).toThrow(/pixel \(/)
})

it.each([NaN, Infinity, -1e-3])('fails when a number is %s', wrong => {
  const broken = picture((x, y, channel) => (x === 30 && y === 17 && channel === 2 ? wrong : null))
  expect(() => check(broken)).toThrow(/channel 2 of pixel \(30, 17\)/)
})

it('leaves empty space alone, but for what is no light', () => {
  const isGround = (_: number, y: number): boolean => y >= height / 2
  const space = black((_, y) => y < height / 2)
  expect(check(space, isGround).median).toBeGreaterThan(0.2)
  expect(() => check(space, () => false)).toThrow('nothing must be lit')
})
