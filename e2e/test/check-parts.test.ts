import { expect, it } from 'vitest'
import { checkPicture, measurePassing } from '../gpu/harness/check-parts'
import { Picture } from '../gpu/harness/picture'
import type { FeatureName } from '../gpu/harness/predict'

/** A row of grey pixels. */
const row = (...values: number[]): Picture =>
  new Picture(values.length, 1, new Float32Array(values.flatMap(value => [value, value, value, 1])))

/** Four pixels: no cloud, a thin one, one that passes a fiftieth, an opaque one. */
const through = [1, 0.5, 0.02, 0]
const cloud = row(1, 0.9, 0.8, 0.8)
const sky = row(1, 1, 1, 1)
const stars = row(1, 50, 50, 50)
const passing = measurePassing((names, isWhite) => {
  const picture = names.includes('clouds') ? cloud : sky
  const passes = (i: number): number => (names.includes('clouds') ? through[i] : 1)
  return row(...[0, 1, 2, 3].map(i => picture.data[4 * i] + (isWhite ? 1000 * passes(i) : 0)))
})

it('measures what features let through', () => {
  const measured = passing.get('clouds')!.filter((_, i) => i % 4 === 0)
  for (const [i, value] of measured.entries()) expect(value).toBeCloseTo(through[i], 4)
  expect([...passing.get('heightFog')!.subarray(0, 3)]).toEqual([1, 1, 1])
})

it('throws where nothing behind is white', () => {
  expect(() => measurePassing(() => sky)).toThrow('over white')
})

const names: FeatureName[] = ['starsOverlay', 'clouds']
const check = (drawn: Picture) => checkPicture(names, drawn, sky, [stars, cloud], passing)
/** Stars through the clouds as they are, with that in one pixel. */
const drawn = (pixel?: number, value = 0): Picture => {
  const right = [1, 0.9 + 0.5 * 49, 0.8 + 0.02 * 49, 0.8]
  return row(...right.map((each, i) => (i === pixel ? value : each)))
}

it('passes stars that clouds dim, all known', () => {
  const { known, mixed, wrong } = check(drawn())
  expect(wrong).toBeUndefined()
  expect(known).toBe(1)
  expect(mixed).toEqual({ known: 9, all: 9 })
})

it.each([
  ['at full strength through an opaque cloud', 3, 49.8],
  ['at a tenth of it', 3, 5.7],
  ['at full strength through a dense cloud', 2, 49.8],
  ['undimmed by a thin cloud', 1, 49.9],
  ['gone behind a thin cloud', 1, 0.9]
])('fails with stars %s', (_, pixel, value) => {
  expect(check(drawn(pixel, value)).wrong).toContain(`of (${pixel}, 0)`)
})
