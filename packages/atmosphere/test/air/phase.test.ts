import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { asymmetryMoments, cornetteShanksPhase, rayleighPhase } from '../../src/air/cpu/phase'
import { gaussLegendre } from '../../src/math/cpu/quadrature'
import { number, runs } from '../arbitraries'

const legendre = [() => 1, (x: number) => x, (x: number) => (3 * x * x - 1) / 2] as const

/** 2π ∫ f(ν) dν, over pieces that crowd where a peak may be. */
function overSphere(f: (nu: number) => number): number {
  const { nodes, weights } = gaussLegendre(40)
  const ends = [-1, -0.99, -0.96, -0.8, 0, 0.8, 0.96, 0.99, 1]
  let sum = 0
  for (let piece = 0; piece + 1 < ends.length; piece++) {
    const length = ends[piece + 1] - ends[piece]
    nodes.forEach((node, i) => (sum += f(ends[piece] + length * node) * weights[i] * length))
  }
  return 2 * Math.PI * sum
}

describe('phase functions', () => {
  it('send on all of the light', () => {
    expect(overSphere(rayleighPhase)).toBeCloseTo(1, 12)
    fc.assert(
      fc.property(number(-0.9, 0.9), g => {
        expect(Math.abs(overSphere(nu => cornetteShanksPhase(g, nu)) - 1)).toBeLessThan(1e-7)
      }),
      runs
    )
  })

  it('have the Legendre coefficients that are claimed', () => {
    fc.assert(
      fc.property(number(-0.9, 0.9), g => {
        const integrals = legendre.map(p => overSphere(nu => cornetteShanksPhase(g, nu) * p(nu)))
        asymmetryMoments(g).forEach((moment, l) => {
          expect(Math.abs(moment - integrals[l])).toBeLessThan(1e-7)
        })
      }),
      runs
    )
    const rayleigh = legendre.map(p => overSphere(nu => rayleighPhase(nu) * p(nu)))
    expect(rayleigh[1]).toBeCloseTo(0, 12)
    expect(rayleigh[2]).toBeCloseTo(0.1, 12)
  })

  it('of aerosols without asymmetry is that of molecules', () => {
    for (const nu of [-1, -0.3, 0, 0.7, 1]) {
      expect(cornetteShanksPhase(0, nu)).toBeCloseTo(rayleighPhase(nu), 14)
    }
  })
})
