import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { applyMoments } from '../../src/diffuseLight/cpu/moments'
import { asymmetryMoments, cornetteShanksPhase, rayleighPhase } from '../../src/air/cpu/phase'
import { gaussLegendre } from '../../src/math/cpu/quadrature'
import { cosine, number, runs } from '../arbitraries'

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

describe('moments', () => {
  it('of light from the sun alone give Legendre polynomials of the angle to it', () => {
    fc.assert(
      fc.property(
        number(-0.999, 0.999),
        cosine,
        number(0, Math.PI),
        number(-2, 2),
        number(-2, 2),
        (cosLight, cosView, azimuth, a1, a2) => {
          const sinLight = Math.sqrt(1 - cosLight ** 2)
          const nu = cosView * cosLight + Math.sqrt(1 - cosView ** 2) * sinLight * Math.cos(azimuth)
          const [y0, y1] = [Math.sqrt(1 / (4 * Math.PI)), Math.sqrt(3 / (4 * Math.PI))]
          const y2 = Math.sqrt(5 / (16 * Math.PI))
          const moments = [
            y0,
            y1 * cosLight,
            y1,
            y2 * (3 * cosLight ** 2 - 1),
            y2 * Math.sqrt(12) * cosLight,
            y2 * Math.sqrt(3)
          ]
          const expected = [1, a1, a2].reduce(
            (sum, a, l) => sum + ((a * (2 * l + 1)) / (4 * Math.PI)) * legendre[l](nu),
            0
          )
          const actual = applyMoments(moments, [1, a1, a2], cosView, cosLight, nu)
          expect(Math.abs(actual - expected)).toBeLessThan(1e-9)
        }
      ),
      runs
    )
  })

  it('stay finite with the sun in the zenith', () => {
    expect(applyMoments([1, 1, 1, 1, 1, 1], [1, 1, 1], 0.5, 1, 0.5)).toBeGreaterThan(0)
  })
})

describe('Gauss–Legendre quadrature', () => {
  it.each([1, 2, 3, 6, 8, 12, 16])('of %i nodes is exact to degree 2n − 1', count => {
    const { nodes, weights } = gaussLegendre(count)
    for (let degree = 0; degree < 2 * count; degree++) {
      const sum = nodes.reduce((total, node, i) => total + weights[i] * node ** degree, 0)
      expect(Math.abs(sum - 1 / (degree + 1))).toBeLessThan(1e-13)
    }
    expect(nodes).toEqual(nodes.toSorted((a, b) => a - b))
  })
})
