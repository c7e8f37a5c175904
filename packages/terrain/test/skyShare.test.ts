import fc from 'fast-check'
import { expect, it } from 'vitest'
import { skyShare } from '../src/pages/cpu/skyShare'

const slopes = fc.double({ min: -2, max: 2, noNaN: true })

it('is the whole sky on a slope, however steep, and on a summit', () => {
  fc.assert(
    fc.property(slopes, slopes, (a, b) => {
      expect(skyShare((east, north) => a * east + b * north, a, b)).toBeCloseTo(1, 12)
      expect(skyShare((east, north) => -Math.hypot(east, north), 0, 0)).toBe(1)
    })
  )
})

it('is cos² of the horizon at the bottom of a cone', () => {
  fc.assert(
    fc.property(fc.double({ min: 0, max: 80, noNaN: true }), degrees => {
      const angle = (degrees * Math.PI) / 180
      const cone = (east: number, north: number): number =>
        Math.tan(angle) * Math.hypot(east, north)
      expect(skyShare(cone, 0, 0)).toBeCloseTo(Math.cos(angle) ** 2, 9)
    })
  )
})

it('falls with the height of a wall', () => {
  const by = (height: number): number => skyShare((_, north) => (north > 50 ? height : 0), 0, 0)
  expect(by(200)).toBeLessThan(by(100))
  expect(by(100)).toBeLessThan(1)
  expect(by(1e6)).toBeGreaterThan(0.3)
})
