import type { CloudPhaseParameters } from './cloudPhase'
import { scalePhase } from './cloudPhase'
import { slabTableForm } from './slabTableForm'
import { SlabSolver } from './solveSlab'

const { bend, lightAngles, positions, thickest, thicknesses } = slabTableForm

const stretch = (depth: number): number => Math.log1p(depth / bend)

/** Thickness of a row: rows are even in ln(1 + T/b). */
const thicknessOfRow = (row: number): number => bend * Math.expm1(row * stretch(thickest))

/** Depth of a column: (1 + d/b) e^{−s} = (1 + (T − d)/b) with s = (2w − 1) ln(1 + T/b). */
function depthOfColumn(column: number, thickness: number): number {
  const ratio = Math.exp((2 * column - 1) * stretch(thickness))
  return (ratio * (bend + thickness) - bend) / (1 + ratio)
}

/** Cosine of the lowest light; one still lower over a slab gives the same moments. */
const LOWEST_COSINE = 0.004

/**
 * Computes the cloud-light table, a thickness per step.
 *
 * @param data - Four numbers per texel: positions fastest, then thicknesses, then layers. Layers hold
 *   (s00, s10, s20, s11) per angle of the light, then (s21, s22, 0, 0) per angle, then (s00, s10, s20, 0)
 *   of the sky's light.
 */
export function* fillCloudLight(
  phase: CloudPhaseParameters,
  data: Float32Array
): Generator<void, void, void> {
  const solver = new SlabSolver(scalePhase(phase))
  const put = (layer: number, row: number, column: number, values: number[]): void =>
    data.set(values, 4 * ((layer * thicknesses + row) * positions + column))
  for (let row = 0; row < thicknesses; row++) {
    const thickness = Math.max(thicknessOfRow(row / (thicknesses - 1)), 1e-4)
    const slab = solver.slab(
      thickness,
      Array.from({ length: positions }, (_, i) => depthOfColumn(i / (positions - 1), thickness))
    )
    for (let layer = 0; layer < lightAngles; layer++) {
      const field = slab.fromBeam(Math.max(layer / (lightAngles - 1), LOWEST_COSINE))
      field.forEach(({ s00, s10, s20, s11, s21, s22 }, column) => {
        put(layer, row, column, [s00, s10, s20, s11])
        put(lightAngles + layer, row, column, [s21, s22, 0, 0])
      })
    }
    slab.fromSky().forEach(({ s00, s10, s20 }, column) => {
      put(2 * lightAngles, row, column, [s00, s10, s20, 0])
    })
    yield
  }
}
