import type { CloudPhaseParameters } from '../../src/light/cpu/cloudPhase'
import { fillCloudLight } from '../../src/light/cpu/cloudLightTable'
import { slabTableForm } from '../../src/light/cpu/slabTableForm'
import type { SourceMoments } from '../../src/light/cpu/solveSlab'

const { bend, layers, lightAngles, positions, thickest, thicknesses } = slabTableForm

const stretch = (depth: number): number => Math.log1p(depth / bend)

/** Row of a thickness, in [0, 1]. */
export function slabRow(thickness: number): number {
  return Math.min(stretch(thickness) / stretch(thickest), 1)
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

/** The finished table, in float32. */
export function solveCloudLight(phase: CloudPhaseParameters): Float32Array {
  const data = new Float32Array(4 * positions * thicknesses * layers)
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
  [column, row, light]: [number, number, number],
  first: number
): number[] {
  const axes = [split(column, positions), split(row, thicknesses), split(light, lightAngles)]
  const result = [0, 0, 0, 0]
  for (let corner = 0; corner < 8; corner++) {
    const steps = [corner & 1, (corner >> 1) & 1, corner >> 2]
    const weight = axes.reduce((w, [, part], i) => w * (steps[i] === 1 ? part : 1 - part), 1)
    if (weight === 0) continue
    const [x, y, z] = axes.map(([below], i) => below + steps[i])
    const at = 4 * (((first + z) * thicknesses + y) * positions + x)
    for (let c = 0; c < 4; c++) result[c] += weight * data[at + c]
  }
  return result
}

/**
 * Moments of the source of light scattered more than once, from the table.
 *
 * @param depth - Scaled depth below the slab's face towards the light, along its normal.
 * @param thickness - Scaled optical thickness of the slab.
 * @param cosLight - μ_s against the slab's normal, in [0, 1].
 */
export function sampleBeamSource(
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
  const [s21, s22] = sample(data, place, lightAngles)
  return { s00, s10, s20, s11, s21, s22 }
}

/**
 * Moments (s00, s10, s20) of the source of light from an isotropic sky of radiance 1, all orders, from
 * the table. The ground's are those at the same depth from below, with s10 negated.
 *
 * @param depth - Scaled depth below the slab's top.
 * @param thickness - Scaled optical thickness of the slab.
 */
export function sampleSkySource(
  data: Float32Array,
  depth: number,
  thickness: number
): [number, number, number] {
  const place: [number, number, number] = [slabColumn(depth, thickness), slabRow(thickness), 0]
  const [s00, s10, s20] = sample(data, place, 2 * lightAngles)
  return [s00, s10, s20]
}
