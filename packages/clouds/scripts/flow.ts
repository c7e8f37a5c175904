import { flowFit as fit } from '../src/light/cpu/flow'
import type { SlabSolver } from '../src/light/cpu/solveSlab'
import { RINGS, STEPS, type SphereLight } from './sphere'

/** Terms of the flow of light in a sphere of a scaled optical diameter: along the light's ray, of the square, aside at the sphere's rim. */
export function flowTerms(diameter: number, chi1: number, chi2: number): [number, number, number] {
  const depth = (1 - chi1) * diameter
  return [
    (fit.along[0] * chi1 ** 2) / (1 + depth / fit.along[1]),
    (fit.square[0] * chi2) / (1 + depth / fit.square[1]),
    (3 * chi1 * fit.aside[0]) / (1 + depth / fit.aside[1])
  ]
}

/** Terms of the flow in a Monte-Carlo solution: means over the light of what its moments have over a slab's, as thick as the ring. */
export function flowOver(
  light: SphereLight,
  solver: SlabSolver,
  diameter: number,
  chi1: number,
  chi2: number
): [number, number, number] {
  let [total, along, square, aside, radii] = [0, 0, 0, 0, 0]
  for (let ring = 0; ring < RINGS; ring++) {
    const [share, thickness] = [
      (ring + 0.5) / RINGS,
      diameter * Math.sqrt(1 - (ring + 0.5) / RINGS)
    ]
    const depths = Array.from({ length: STEPS }, (_, i) => ((i + 0.5) / STEPS) * thickness)
    const slab = solver.slab(thickness, depths).fromBeam(1)
    slab.forEach(({ s00, s10, s20 }, i) => {
      const cell = ring * STEPS + i
      const source = light.source[cell]
      if (!(source > 0)) return
      total += source
      along += 3 * chi1 * light.along[cell] - (source * s10) / s00
      square += 5 * chi2 * light.square[cell] - (source * s20) / s00
      // Aside in proportion to the distance from the axis: least squares.
      aside += 3 * chi1 * light.aside[cell] * Math.sqrt(share)
      radii += source * share
    })
  }
  return [along / total, square / total, aside / radii]
}
