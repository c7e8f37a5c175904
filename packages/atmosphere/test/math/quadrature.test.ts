import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { gaussLegendre, weightsTo } from '../../src/math/cpu/quadrature'

describe('weightsTo', () => {
  const powers = fc.array(fc.double({ min: -3, max: 3, noNaN: true }), {
    minLength: 1,
    maxLength: 5
  })

  it('integrates polynomials of less than the number of nodes exactly', () => {
    const { nodes } = gaussLegendre(5)
    fc.assert(
      fc.property(powers, fc.double({ min: 0, max: 1, noNaN: true }), (coefficients, end) => {
        const at = (x: number): number => coefficients.reduce((sum, c, i) => sum + c * x ** i, 0)
        const sum = weightsTo(nodes, end).reduce((total, w, i) => total + w * at(nodes[i]), 0)
        const exact = coefficients.reduce(
          (total, c, i) => total + (c * end ** (i + 1)) / (i + 1),
          0
        )
        expect(sum).toBeCloseTo(exact, 10)
      })
    )
  })

  it('is the rule itself over its whole interval', () => {
    const { nodes, weights } = gaussLegendre(3)
    weightsTo(nodes, 1).forEach((weight, i) => expect(weight).toBeCloseTo(weights[i], 12))
  })

  it("has Kuntzmann's and Butcher's coefficients at its own nodes", () => {
    const { nodes } = gaussLegendre(3)
    const root = Math.sqrt(15)
    const expected = [5 / 36, 2 / 9 - root / 15, 5 / 36 - root / 30]
    weightsTo(nodes, nodes[0]).forEach((w, i) => expect(w).toBeCloseTo(expected[i], 12))
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
