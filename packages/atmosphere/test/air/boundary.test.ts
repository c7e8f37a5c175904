import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { distanceToGround, distanceToTop, hitsGround } from '../../src/air/cpu/boundary'
import { cosine, number, runs } from '../arbitraries'

const bottom = 6_360_000
const top = 6_420_000

/** Distance from the planet's centre to a point on a ray. */
const radiusAt = (radius: number, mu: number, t: number): number =>
  Math.hypot(radius * Math.sqrt(Math.max(1 - mu * mu, 0)), radius * mu + t)

describe('boundary', () => {
  it('ends rays to the top on the top', () => {
    fc.assert(
      fc.property(number(bottom, top), cosine, (radius, mu) => {
        expect(Math.abs(radiusAt(radius, mu, distanceToTop(radius, mu, top)) - top)).toBeLessThan(
          0.01
        )
      }),
      runs
    )
  })

  it('ends rays that meet the ground on the ground, on their way down', () => {
    fc.assert(
      fc.property(number(bottom, 4 * bottom), number(-1, 0), (radius, mu) => {
        fc.pre(hitsGround(radius, mu, bottom))
        const t = distanceToGround(radius, mu, bottom)
        expect(Math.abs(radiusAt(radius, mu, t) - bottom)).toBeLessThan(0.01)
        expect(t).toBeLessThanOrEqual(-radius * mu + 1e-6)
      }),
      runs
    )
  })

  it('knows the horizon', () => {
    fc.assert(
      fc.property(number(1, 2e7), height => {
        const horizon = -Math.sqrt(height * (2 * bottom + height)) / (bottom + height)
        expect(hitsGround(bottom + height, horizon - 1e-9, bottom)).toBe(true)
        expect(hitsGround(bottom + height, horizon + 1e-9, bottom)).toBe(false)
      }),
      runs
    )
  })

  it('goes straight up and down', () => {
    expect(distanceToTop(bottom, 1, top)).toBeCloseTo(60_000, 6)
    expect(distanceToGround(top, -1, bottom)).toBeCloseTo(60_000, 6)
  })
})
