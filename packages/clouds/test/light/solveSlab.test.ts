import fc from 'fast-check'
import { gaussLegendre } from '@welkin/atmosphere'
import { describe, expect, it } from 'vitest'
import {
  scalePhase,
  type CloudPhaseParameters,
  type ScaledPhase
} from '../../src/light/cpu/cloudPhase'
import { SlabSolver, type SourceMoments } from '../../src/light/cpu/solveSlab'

const conservative = 0.999_999_9
const isotropic = (albedo: number): ScaledPhase => ({
  depthScale: 1,
  albedo,
  moments: [1, 0, 0]
})

const lobes: CloudPhaseParameters = {
  forwardAsymmetry: 0.8,
  backwardAsymmetry: -0.2,
  forwardShare: 0.8,
  scatteringAlbedo: conservative
}

const rule = gaussLegendre(64)
/** Places for ∫ f from 0 to end, crowded towards 0. */
const crowded = (end: number): number[] => rule.nodes.map(x => x * x * end)
const integrate = (end: number, f: (x: number, i: number) => number): number =>
  crowded(end).reduce((sum, x, i) => sum + rule.weights[i] * 2 * rule.nodes[i] * end * f(x, i), 0)

const legendre2 = (mu: number): number => (3 * mu * mu - 1) / 2

/** Light scattered once plus more often, towards a viewpoint seen under μ, at azimuth φ from the sun. */
function source(
  { albedo, moments: [, chi1, chi2] }: ScaledPhase,
  m: SourceMoments,
  depth: number,
  [mu, mu0, phi]: [number, number, number]
): number {
  const sines = Math.sqrt((1 - mu * mu) * (1 - mu0 * mu0))
  const a = sines * Math.cos(phi)
  const nu = a + mu * mu0
  const phase = (1 + 3 * chi1 * nu + 5 * chi2 * legendre2(nu)) / (4 * Math.PI)
  const more = m.s00 + m.s10 * mu + m.s20 * legendre2(mu) + (m.s11 + m.s21 * mu) * a
  return more + m.s22 * (2 * a * a - sines ** 2) + albedo * phase * Math.exp(-depth / mu0)
}

/** Radiance that a slab reflects, for a thickness that matters at both ends. */
function reflected(
  phase: ScaledPhase,
  thickness: number,
  [mu, mu0, phi]: [number, number, number]
): number {
  const field = new SlabSolver(phase).slab(thickness, crowded(thickness)).fromBeam(mu0)
  return integrate(
    thickness,
    (d, i) => (source(phase, field[i], d, [-mu, mu0, phi]) * Math.exp(-d / mu)) / mu
  )
}

const phases = fc.record({
  forwardAsymmetry: fc.double({ min: 0, max: 0.9, noNaN: true }),
  backwardAsymmetry: fc.double({ min: -0.6, max: 0.6, noNaN: true }),
  forwardShare: fc.double({ min: 0, max: 1, noNaN: true }),
  scatteringAlbedo: fc.constant(conservative)
})
const cosines = fc.double({ min: 0.15, max: 1, noNaN: true })
const thicknesses = fc.double({ min: -2, max: 4, noNaN: true }).map(Math.exp)

describe('SlabSolver', () => {
  it('loses no light: a slab that does not absorb reflects and transmits all', () => {
    fc.assert(
      fc.property(phases, cosines, thicknesses, (lobesOf, mu0, thickness) => {
        const phase = scalePhase(lobesOf)
        const { moments } = phase
        const solver = new SlabSolver(phase)
        // Flux of the source over both hemispheres; azimuth leaves only m = 0.
        const flux = (side: 1 | -1): number => {
          const depths = crowded(thickness).map(near => (side === 1 ? thickness - near : near))
          const field = solver.slab(thickness, depths).fromBeam(mu0)
          return integrate(thickness, (near, i) => {
            const m = field[i]
            const depth = depths[i]
            const beam = (phase.albedo * Math.exp(-depth / mu0)) / (4 * Math.PI)
            return integrate(1, mu => {
              const s0 = m.s00 + beam
              const s1 = m.s10 + 3 * moments[1] * mu0 * beam
              const s2 = m.s20 + 5 * moments[2] * legendre2(mu0) * beam
              const light = s0 + side * s1 * mu + s2 * legendre2(mu)
              return 2 * Math.PI * light * Math.exp(-near / mu)
            })
          })
        }
        const out = flux(1) + flux(-1) + mu0 * Math.exp(-thickness / mu0)
        expect(out / mu0).toBeCloseTo(1, 2.5)
      }),
      { numRuns: 30 }
    )
  })

  it('reflects like Chandrasekhar’s H function in thick isotropic slabs', () => {
    const albedo = 0.9
    // H by iteration of its nonlinear integral equation: Chandrasekhar 1960, V §37.
    let h = rule.nodes.map(() => 1)
    const value = (mu: number): number =>
      1 /
      (Math.sqrt(1 - albedo) +
        (albedo / 2) *
          rule.nodes.reduce((sum, x, i) => sum + (rule.weights[i] * x * h[i]) / (mu + x), 0))
    for (let round = 0; round < 200; round++) h = rule.nodes.map(value)
    for (const [mu, mu0] of [
      [1, 1],
      [0.5, 0.9],
      [0.9, 0.3],
      [0.4, 0.2]
    ]) {
      const expected = (albedo / (4 * Math.PI)) * (mu0 / (mu + mu0)) * value(mu) * value(mu0)
      const model = reflected(isotropic(albedo), 40, [mu, mu0, 1])
      expect(model / expected).toBeCloseTo(1, 3)
    }
  })

  it('is reciprocal: swapping sun and viewpoint scales radiance by their cosines', () => {
    const phase = scalePhase({ ...lobes, scatteringAlbedo: 0.99 })
    fc.assert(
      fc.property(
        cosines,
        cosines,
        fc.double({ min: 0, max: Math.PI, noNaN: true }),
        fc.double({ min: 0.2, max: 20, noNaN: true }),
        (mu, mu0, phi, thickness) => {
          const there = reflected(phase, thickness, [mu, mu0, phi]) / mu0
          const back = reflected(phase, thickness, [mu0, mu, phi]) / mu
          expect(there / back).toBeCloseTo(1, 2.5)
        }
      ),
      { numRuns: 30 }
    )
  })

  it('is invisible between a sky and a ground of equal radiance when it does not absorb', () => {
    const phase = scalePhase(lobes)
    for (const thickness of [0.05, 1, 10, 80]) {
      const depths = [0, 0.03, 0.4, 0.5, 0.6, 0.97, 1].map(part => part * thickness)
      const field = new SlabSolver(phase).slab(thickness, depths).fromSky()
      for (const [i, above] of field.entries()) {
        const below = field[depths.length - 1 - i]
        expect(above.s00 + below.s00).toBeCloseTo(1, 3)
        expect(above.s10 - below.s10).toBeCloseTo(0, 3)
        expect(above.s20 + below.s20).toBeCloseTo(0, 3)
      }
    }
  })

  it('hardly changes with more streams', () => {
    const phase = scalePhase(lobes)
    for (const thickness of [0.3, 3, 30]) {
      for (const mu0 of [0.1, 0.5, 1]) {
        const [few, many] = [8, 24].map(streams =>
          new SlabSolver(phase, streams)
            .slab(thickness, [0, 0.1 * thickness, thickness / 2, thickness])
            .fromBeam(mu0)
        )
        for (const [i, a] of few.entries()) {
          const b = many[i]
          expect(a.s00 / b.s00).toBeCloseTo(1, 2)
          expect(a.s11 / b.s00).toBeCloseTo(b.s11 / b.s00, 2)
        }
      }
    }
  })
})
