import fc from 'fast-check'
import { expect, it } from 'vitest'
import { bouncedLight } from '../src/surface/cpu/bouncedLight'

const unit = fc.double({ min: 0.01, max: 0.99, noNaN: true })

it('leaves no more light in a hollow than falls into it', () => {
  fc.assert(
    fc.property(unit, unit, (albedo, share) => {
      const light = share * bouncedLight(albedo, share)
      expect(light).toBeGreaterThanOrEqual(share)
      expect(light).toBeLessThanOrEqual(1 + 1e-9)
      // What is absorbed and what leaves by the opening are what comes in by it.
      const absorbed = light * (1 - albedo)
      const leaving = light * albedo * share
      expect(absorbed + leaving).toBeCloseTo(share, 9)
    })
  )
})

it('is none on open ground and on black ground', () => {
  expect(bouncedLight(0.8, 1)).toBe(1)
  expect(bouncedLight(0, 0.3)).toBe(1)
})
