import type { CloudPhaseParameters } from './cloudPhase'
import { depths, layers, positions, suns } from './cloudLightSize'
import { scalePhase } from './cloudPhase'
import { SlabSolver, type SourceMoments } from './solveSlab'

/** Depths well below this are spaced evenly, those well above it by their logarithm. */
export const CLOUD_LIGHT_BEND = 0.4

/** Scaled optical thickness of the thickest slab; thicker ones look like it from their ends. */
export const CLOUD_LIGHT_THICKEST = 200

const stretch = (depth: number): number => Math.log1p(depth / CLOUD_LIGHT_BEND)

/** Row of a thickness, in [0, 1]. */
export function slabRow(thickness: number): number {
  return Math.min(stretch(thickness) / stretch(CLOUD_LIGHT_THICKEST), 1)
}

/**
 * Column of a place in a slab, in [0, 1]: columns crowd at both faces, where light changes within a
 * depth of one.
 *
 * @param depth - Scaled depth below the face that the light comes in at, in [0, thickness].
 */
export function slabColumn(depth: number, thickness: number): number {
  if (thickness <= 0) return 0.5
  return 0.5 + (0.5 * (stretch(depth) - stretch(thickness - depth))) / stretch(thickness)
}

const thicknessOfRow = (row: number): number =>
  CLOUD_LIGHT_BEND * Math.expm1(row * stretch(CLOUD_LIGHT_THICKEST))

/** The inverse of `slabColumn`: (1 + d/b) e^{−s} = (1 + (T − d)/b) with s = (2w − 1) ln(1 + T/b). */
function depthOfColumn(column: number, thickness: number): number {
  const ratio = Math.exp((2 * column - 1) * stretch(thickness))
  return (ratio * (CLOUD_LIGHT_BEND + thickness) - CLOUD_LIGHT_BEND) / (1 + ratio)
}

/** The sun this low over a slab is as good as at its horizon. */
const LOWEST_COSINE = 0.004

/**
 * Computes the cloud-light table, a thickness per step.
 *
 * @param data - Four numbers per texel: positions fastest, then thicknesses, then layers. Layers hold
 *   (s00, s10, s20, s11) per sun angle, then (s21, s22, 0, 0) per sun angle, then (s00, s10, s20, 0) of
 *   the sky's light.
 */
export function* fillCloudLight(
  phase: CloudPhaseParameters,
  data: Float32Array
): Generator<void, void, void> {
  const solver = new SlabSolver(scalePhase(phase))
  const put = (layer: number, row: number, column: number, values: number[]): void =>
    data.set(values, 4 * ((layer * depths + row) * positions + column))
  for (let row = 0; row < depths; row++) {
    const thickness = Math.max(thicknessOfRow(row / (depths - 1)), 1e-4)
    const slab = solver.slab(
      thickness,
      Array.from({ length: positions }, (_, i) => depthOfColumn(i / (positions - 1), thickness))
    )
    for (let layer = 0; layer < suns; layer++) {
      const field = slab.fromSun(Math.max(layer / (suns - 1), LOWEST_COSINE))
      field.forEach(({ s00, s10, s20, s11, s21, s22 }, column) => {
        put(layer, row, column, [s00, s10, s20, s11])
        put(suns + layer, row, column, [s21, s22, 0, 0])
      })
    }
    slab.fromAbove().forEach(({ s00, s10, s20 }, column) => {
      put(2 * suns, row, column, [s00, s10, s20, 0])
    })
    yield
  }
}

/** The finished table, in float32. */
export function solveCloudLight(phase: CloudPhaseParameters): Float32Array {
  const data = new Float32Array(4 * positions * depths * layers)
  for (const _ of fillCloudLight(phase, data)) continue
  return data
}

const split = (coordinate: number, count: number): [number, number] => {
  const x = Math.min(Math.max(coordinate, 0), 1) * (count - 1)
  const below = Math.min(Math.floor(x), count - 2)
  return [below, x - below]
}

/** Trilinear look-up of four numbers; layers are interpolated from `first` on, if there are several. */
function sample(
  data: Float32Array,
  [column, row, sun]: [number, number, number],
  first: number
): number[] {
  const axes = [split(column, positions), split(row, depths), split(sun, suns)]
  const result = [0, 0, 0, 0]
  for (let corner = 0; corner < 8; corner++) {
    const steps = [corner & 1, (corner >> 1) & 1, corner >> 2]
    const weight = axes.reduce((w, [, part], i) => w * (steps[i] === 1 ? part : 1 - part), 1)
    if (weight === 0) continue
    const [x, y, z] = axes.map(([below], i) => below + steps[i])
    const at = 4 * (((first + z) * depths + y) * positions + x)
    for (let c = 0; c < 4; c++) result[c] += weight * data[at + c]
  }
  return result
}

/**
 * Moments of the source of light scattered more than once, from the table.
 *
 * @param depth - Scaled depth below the slab's sunward face, along its normal.
 * @param thickness - Scaled optical thickness of the slab.
 * @param cosLight - μ_s against the slab's normal, in [0, 1].
 */
export function sampleSunlitSlab(
  data: Float32Array,
  depth: number,
  thickness: number,
  cosLight: number
): SourceMoments {
  const place: [number, number, number] = [
    slabColumn(depth, thickness),
    slabRow(thickness),
    cosLight
  ]
  const [s00, s10, s20, s11] = sample(data, place, 0)
  const [s21, s22] = sample(data, place, suns)
  return { s00, s10, s20, s11, s21, s22 }
}

/**
 * Moments (s00, s10, s20) of the source of light from an isotropic sky of radiance 1, all orders, from
 * the table. The ground's are those at the same depth from below, with s10 negated.
 *
 * @param depth - Scaled depth below the slab's top.
 * @param thickness - Scaled optical thickness of the slab.
 */
export function sampleSkylitSlab(
  data: Float32Array,
  depth: number,
  thickness: number
): [number, number, number] {
  const place: [number, number, number] = [slabColumn(depth, thickness), slabRow(thickness), 0]
  const [s00, s10, s20] = sample(data, place, 2 * suns)
  return [s00, s10, s20]
}
