import fc from 'fast-check'
import { gaussLegendre } from '@welkin/atmosphere'
import { describe, expect, it } from 'vitest'
import { scalePhase } from '../../src/light/cpu/cloudPhase'
import { SlabSolver } from '../../src/light/cpu/solveSlab'
import {
  eddingtonDiffuse,
  eddingtonTransmittance,
  stackDecks,
  type CloudDeck
} from '../../src/environment/cpu/decks'
import * as shipped from '../../src/environment/cpu/overcast'
import { cloudyIrradiance } from '../twins/overcast'

const phase = scalePhase({
  forwardAsymmetry: 0.8,
  backwardAsymmetry: -0.2,
  forwardShare: 0.8,
  scatteringAlbedo: 0.999_999_9
})
const oneMinusAsymmetry = 1 - phase.moments[1]
const solver = new SlabSolver(phase)

const rule = gaussLegendre(48)
/** ∫ f from 0 to end, by places crowded towards 0. */
const places = (end: number): number[] => rule.nodes.map(x => x * x * end)
const integrate = (end: number, f: (x: number, i: number) => number): number =>
  places(end).reduce((sum, x, i) => sum + rule.weights[i] * 2 * rule.nodes[i] * end * f(x, i), 0)
const legendre2 = (mu: number): number => (3 * mu * mu - 1) / 2

/** Part of the sun's light that a slab passes, by its solution with 8 streams. */
function transmittance(thickness: number, mu0: number): number {
  const depths = places(thickness).map(near => thickness - near)
  const field = solver.slab(thickness, depths).fromBeam(mu0)
  const [, chi1, chi2] = phase.moments
  const scattered = integrate(thickness, (near, i) => {
    const { s00, s10, s20 } = field[i]
    const beam = (phase.albedo * Math.exp(-depths[i] / mu0)) / (4 * Math.PI)
    return integrate(1, mu => {
      const s = s00 + beam + (s20 + 5 * chi2 * legendre2(mu0) * beam) * legendre2(mu)
      const along = (s10 + 3 * chi1 * mu0 * beam) * mu
      // Directions of sight and of the moments: down, as the sun's rays are.
      return 2 * Math.PI * (s + along) * Math.exp(-near / mu)
    })
  })
  return scattered / mu0 + Math.exp(-thickness / mu0)
}

describe('eddingtonTransmittance', () => {
  it('is the slab’s solution within 0.035 of all light, and a tenth of what passes', () => {
    for (const thickness of [0.1, 0.5, 1, 2, 4, 8, 16, 32, 64]) {
      for (const mu0 of [0.2, 0.35, 0.5, 0.75, 1]) {
        const exact = transmittance(thickness, mu0)
        const model = eddingtonTransmittance(thickness, mu0, oneMinusAsymmetry)
        expect(Math.abs(model - exact)).toBeLessThan(Math.min(0.035, 0.1 * exact))
      }
      const sky = integrate(1, mu => 2 * mu * transmittance(thickness, Math.max(mu, 0.01)))
      expect(Math.abs(eddingtonDiffuse(thickness, oneMinusAsymmetry) - sky)).toBeLessThan(0.03)
    }
  })

  it('has measured overcasts’ share of a clear day’s light at depths that such clouds have', () => {
    // Kasten & Czeplak 1980, "Solar and terrestrial radiation dependent on the amount and type of
    // cloud": stratus 0.18, nimbostratus 0.16. Rossow & Schiffer 1999: both have depths above 23.
    const asymmetry = 0.86
    const share = (depth: number): number => {
      const diffuse = eddingtonDiffuse(depth, 1 - asymmetry)
      const ground = 0.2
      return eddingtonTransmittance(depth, 0.6, 1 - asymmetry) / (1 - ground * (1 - diffuse))
    }
    expect(share(23)).toBeGreaterThan(0.18)
    expect(share(60)).toBeLessThan(0.16)
  })
})

describe('stackDecks', () => {
  const thicknesses = fc.double({ min: 0.01, max: 40, noNaN: true })
  const cosines = fc.double({ min: 0.1, max: 1, noNaN: true })

  it('takes two layers one above the other for one', () => {
    fc.assert(
      fc.property(thicknesses, thicknesses, cosines, (a, b, mu0) => {
        const layers = [a, b].map(thickness => [{ thickness, coverage: 1 }])
        const { diffuse, direct, beam } = stackDecks(layers, mu0, oneMinusAsymmetry)
        expect(diffuse).toBeCloseTo(eddingtonDiffuse(a + b, oneMinusAsymmetry), 9)
        expect(beam).toBeCloseTo(Math.exp(-(a + b) / mu0), 9)
        expect(
          Math.abs(direct - eddingtonTransmittance(a + b, mu0, oneMinusAsymmetry))
        ).toBeLessThan(0.12)
      })
    )
  })

  it('passes no less where clouds cover less', () => {
    fc.assert(
      fc.property(thicknesses, cosines, fc.double({ min: 0, max: 1, noNaN: true }), (a, mu, c) => {
        const some = stackDecks([[{ thickness: a, coverage: c }]], mu, oneMinusAsymmetry)
        const all = stackDecks([[{ thickness: a, coverage: 1 }]], mu, oneMinusAsymmetry)
        for (const part of ['diffuse', 'direct', 'beam'] as const) {
          expect(some[part]).toBeCloseTo(1 - c + c * all[part], 9)
        }
        expect(some.direct).toBeGreaterThanOrEqual(some.beam - 1e-12)
      })
    )
  })
})

describe('cloudyIrradiance, bounce by bounce', () => {
  const none: CloudDeck = { diffuse: 1, direct: 1, beam: 1 }
  const parts = fc.double({ min: 0.01, max: 1, noNaN: true })
  const decks = fc
    .tuple(parts, parts, parts)
    .map(([diffuse, direct, b]) => ({ diffuse, direct, beam: b * direct }))
  const albedos = fc.double({ min: 0, max: 0.9, noNaN: true })
  /** Light where there is no air between clouds and ground. */
  const lights = fc
    .record({ direct: parts, sky: parts, albedo: albedos })
    .map(({ direct, sky, albedo }): shipped.ClearLight & { all: number } => ({
      direct: { above: direct, below: direct },
      sky: { here: sky, below: sky },
      ground: albedo * (direct + sky),
      plane: sky,
      albedo,
      all: direct + sky
    }))

  it('is the clear sky’s without clouds', () => {
    fc.assert(
      fc.property(lights, fc.double({ min: -1, max: 1, noNaN: true }), (clear, cosNormal) => {
        expect(cloudyIrradiance(clear, none, none, cosNormal)).toBeCloseTo(clear.plane, 12)
      })
    )
  })

  it('is the sum of the geometric series that ships', () => {
    // Decks that pass so little that 400 bounces are too few are left out.
    const passing = decks.filter(({ diffuse }) => diffuse > 0.1)
    fc.assert(
      fc.property(
        lights,
        passing,
        passing,
        fc.double({ min: -1, max: 1, noNaN: true }),
        (clear, above, below, cosNormal) => {
          const sum = shipped.cloudyIrradiance(clear, above, below, cosNormal)
          expect(sum).toBeCloseTo(cloudyIrradiance(clear, above, below, cosNormal), 8)
        }
      )
    )
  })

  it('loses no light: what comes in is reflected or warms the ground', () => {
    fc.assert(
      fc.property(lights, decks, (clear, deck) => {
        const under = cloudyIrradiance(clear, deck, none, 1) + clear.direct.above * deck.beam
        // A plane that faces down has the ground's light where the sky is clear.
        const up = cloudyIrradiance({ ...clear, plane: clear.ground }, none, deck, -1)
        expect(up + (1 - clear.albedo) * under).toBeCloseTo(clear.all, 6)
        const fromGround = cloudyIrradiance({ ...clear, plane: clear.ground }, deck, none, -1)
        expect(fromGround).toBeCloseTo(clear.albedo * under, 6)
      })
    )
  })

  it('dims nothing above the clouds, whose white is brighter than dark ground', () => {
    fc.assert(
      fc.property(lights, decks, (clear, deck) => {
        expect(cloudyIrradiance(clear, none, deck, 1)).toBeCloseTo(clear.plane, 12)
        const dark = { ...clear, albedo: 0.05, ground: 0.05 * clear.all }
        const up = cloudyIrradiance({ ...dark, plane: dark.ground }, none, deck, -1)
        if (Math.max(deck.diffuse, deck.direct) < 0.9) expect(up).toBeGreaterThan(dark.ground)
      })
    )
  })

  it('gives an overcast more light than a blue sky alone, and less than a clear day', () => {
    const clear = {
      direct: { above: 0.8, below: 0.8 },
      sky: { here: 0.12, below: 0.12 },
      ground: 0.2 * 0.92,
      plane: 0.12,
      albedo: 0.2
    }
    const deck = stackDecks([[{ thickness: 12, coverage: 1 }]], 0.85, oneMinusAsymmetry)
    const light = cloudyIrradiance(clear, deck, none, 1)
    expect(light).toBeGreaterThan(0.12)
    expect(light).toBeLessThan(0.3 * 0.92)
  })
})
