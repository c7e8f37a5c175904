// Derives the coefficients of src/light/cpu/lateralLeak.ts from Monte-Carlo solutions of spheres of cloud, and prints what those of
// src/light/cpu/flow.ts stand for.
// Run it with: npm run fit-leak
import { factorize } from '../src/light/cpu/matrices'
import { SlabSolver } from '../src/light/cpu/solveSlab'
import { flowOver, flowTerms } from './flow'
import { sphereLight, RINGS, STEPS } from './sphere'

/** χ′₁ and χ′₂ of phase functions from isotropic to Henyey–Greenstein's of 0.85. */
const phases: [number, number][] = [
  [0, 0],
  [0.167, 0.184],
  [0.324, 0.189],
  [0.45, 0.25],
  [0.611, 0.281]
]

/** Scaled optical diameters, and how many photons each is worth. */
const spheres: [number, number][] = [
  [0.3, 1_000_000],
  [0.6, 1_000_000],
  [1.2, 1_000_000],
  [2.5, 1_000_000],
  [5, 800_000],
  [10, 500_000],
  [20, 200_000],
  [40, 100_000]
]

/** Powers of part, depth and chord, by coefficient. */
const powers: Record<string, [number, number, number]> = {
  constant: [0, 0, 0],
  part: [1, 0, 0],
  depth: [0, 1, 0],
  chord: [0, 0, 1],
  part2: [2, 0, 0],
  depth2: [0, 2, 0],
  chord2: [0, 0, 2],
  partDepth: [1, 1, 0],
  depthChord: [0, 1, 1],
  chordPart: [1, 0, 1]
}
const names = Object.keys(powers)

interface Equation {
  terms: number[]
  /** ln of a sphere's source over a slab's. */
  value: number
  weight: number
}

const equations: Equation[] = []
for (const [chi1, chi2] of phases) {
  const solver = new SlabSolver({ depthScale: 1, albedo: 0.99999, moments: [1, chi1, chi2] })
  for (const [diameter, photons] of spheres) {
    // Truncated to three terms this phase function is negative somewhere; weights of alternating sign
    // grow with each collision.
    if (chi1 > 0.5 && diameter > 20) continue
    const light = sphereLight(diameter, chi1, chi2, photons)
    const found = flowOver(light, solver, diameter, chi1, chi2)
    const terms = flowTerms(diameter, chi1, chi2)
    const list = (each: readonly number[]): string => each.map(value => value.toFixed(3)).join(' ')
    console.log(`flow, χ′₁ ${chi1}, D ${diameter}: ${list(found)}; fit ${list(terms)}`)
    for (let ring = 0; ring < RINGS; ring++) {
      const chord = Math.sqrt(1 - (ring + 0.5) / RINGS)
      const thickness = diameter * chord
      const parts = Array.from({ length: STEPS }, (_, i) => (i + 0.5) / STEPS)
      const slab = solver.slab(
        thickness,
        parts.map(part => part * thickness)
      )
      slab.fromBeam(1).forEach(({ s00 }, i) => {
        const source = light.source[ring * STEPS + i]
        if (!(source > 0)) return
        const variables = [parts[i], Math.log(1 + (1 - chi1) * diameter), chord]
        equations.push({
          terms: names.map(name =>
            powers[name].reduce((product, power, k) => product * variables[k] ** power, 1)
          ),
          value: Math.log(source / s00),
          weight: Math.max(source, 1e-4)
        })
      })
    }
  }
}

const normal = names.map((_, i) =>
  names.map((__, j) => equations.reduce((sum, e) => sum + e.weight * e.terms[i] * e.terms[j], 0))
)
const right = names.map((_, i) =>
  equations.reduce((sum, e) => sum + e.weight * e.terms[i] * e.value, 0)
)
const coefficients = factorize(normal)(right)
const total = equations.reduce((sum, e) => sum + e.weight, 0)
const error = equations.reduce((sum, { terms, value, weight }) => {
  const fitted = terms.reduce((s, term, i) => s + term * coefficients[i], 0)
  return sum + weight * (fitted - value) ** 2
}, 0)
names.forEach((name, i) => console.log(`  ${name}: ${coefficients[i].toFixed(4)},`))
console.log(`error ${(100 * Math.sqrt(error / total)).toFixed(1)} % (root mean square)`)
