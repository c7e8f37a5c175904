import { describe, expect, it } from 'vitest'
import { billowForm } from '../../src/density/formConstants'
import { bulge } from '../../src/layers/meanColumn'

const [stemless, carried] = billowForm.bulgeFrom
const [low, high] = billowForm.bulgeAbove

describe('coarse billows', () => {
  it('carve columns of any strength at any height', () => {
    for (const needed of [0, 0.5, 1, 3]) {
      for (const column of [-2, 0, 2]) expect(bulge(-0.7, column, needed)).toBe(-0.7)
    }
  })

  it('bulge out of any column near the base', () => {
    for (const column of [-3, -1, 2]) expect(bulge(0.7, column, low)).toBe(0.7)
  })

  it('bulge above out of columns that nearly reach a height, and not out of those that lack most of it', () => {
    for (const needed of [high, high + 2]) {
      expect(bulge(0.7, needed + carried, needed)).toBe(0.7)
      expect(bulge(0.7, needed + stemless, needed)).toBe(0)
      expect(bulge(0.7, needed + (stemless + carried) / 2, needed)).toBeCloseTo(0.35, 12)
    }
  })

  it('bulge half as much between base and above, where columns lack all', () => {
    const needed = (low + high) / 2
    expect(bulge(0.7, needed + stemless - 1, needed)).toBeCloseTo(0.35, 12)
  })
})
