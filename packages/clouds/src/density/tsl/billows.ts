import { If, float, log2, smoothstep, vec2 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { billowForm } from '../formConstants'
import { NOISE_SIZE } from '../../noise/noiseSizes'
import { ENCODING_SCALE } from '../../noise/noiseRecipes'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { inLattice } from './inLattice'
import type { LayerNodes } from './layer'

/** Level of detail for a footprint; 0 where texels are wider. */
export const levelOf = (footprint: Float, texel: Float | number): Float =>
  log2(footprint.div(texel).max(1)).toConst()

/** Noise of unit deviation from its encoded values. */
export const decoded = (value: Vec4): Vec4 => value.sub(0.5).div(ENCODING_SCALE).toConst()

/** Billows around a place, of unit deviation near by. */
export interface Billows {
  /** Sums of the octaves from a quarter of the shape's period on, and from a sixteenth on [–]. */
  readonly coarse: Float
  readonly fine: Float
  /** Two components of the turbulence [–]. */
  readonly curl: Vec2
}

/**
 * Billows: round bulges that meet in creases, each octave stirred by a curl of its own size, which the
 * noise has baked in. One texture read.
 *
 * @param offset - Displacement from the camera, in the mapped space [m].
 * @param shift - `shift` of `WeatherBackground`.
 * @param level - `Resolution.shapeLevel`: what is finer than `billowForm.footprints` of the sample is left out.
 * @see Schneider & Vos 2015, "The real-time volumetric cloudscapes of Horizon: Zero Dawn", "Modeling"
 * @see Bridson et al. 2007, "Curl-noise for procedural fluid flow", §2
 */
export function billows(
  field: CloudField,
  layer: LayerNodes,
  offset: Vec3,
  shift: Vec2,
  level: Float
): Billows {
  const { perShapePeriod } = layer
  const point = layer.shapeLattice(offset).add(inLattice(shift).mul(perShapePeriod)) as Vec3
  const noise = decoded(field.textures.shape.sample(point).level(level))
  return { coarse: noise.x, fine: noise.y, curl: vec2(noise.z, noise.w).toConst() }
}

/**
 * Periods of the nearer octaves of detail, in those of the detail, and their amplitudes [–]. Greater amplitudes:
 * frayed edges near the camera (*Inside a cloud*).
 */
const NEARER = [
  [1 / 5, 0.55],
  [1 / 25, 0.3]
] as const

/**
 * Footprint over the period of a nearer octave below which it is looked up. Smaller: detail fades nearer to
 * the camera (*Inside a cloud*).
 */
const NEARER_FROM = 5 / 24

/**
 * Detail finer than billows at places near each other, of unit deviation near by: three octaves of one noise, down to a
 * thousandth of its period. What is finer than `billowForm.detailFootprints` of the samples is left out.
 *
 * To be called inside of a shader function.
 */
export function detail(
  field: CloudField,
  layer: LayerNodes,
  samples: readonly { offset: Vec3 }[],
  footprint: Float
): Float[] {
  const { perDetailPeriod } = layer
  const points = samples.map(({ offset }) => layer.detailLattice(offset).toConst() as Vec3)
  const width = footprint.mul(perDetailPeriod).mul(billowForm.detailFootprints).toConst() as Float
  const octave = (period: number): Float[] => {
    const level = levelOf(width.div(period), 1 / NOISE_SIZE.detail)
    return points.map(
      point => field.textures.detail.sample(point.div(period)).level(level).x as Float
    )
  }
  const coarsest = octave(1).map(noise => noise.toConst() as Float)
  // Decoded after all reads: none waits for another.
  const nearer = NEARER.map(([period]) => {
    const read = points.map(() => float(0.5).toVar() as Float)
    If(width.lessThan(NEARER_FROM * period), () => {
      octave(period).forEach((noise, i) => read[i].assign(noise))
    })
    return read
  })
  const deviation = (noise: Float): Float => noise.sub(0.5).div(ENCODING_SCALE)
  return coarsest.map((noise, i) =>
    NEARER.reduce(
      (sum, [, amplitude], k) => sum.add(deviation(nearer[k][i]).mul(amplitude)),
      deviation(noise)
    ).toConst()
  )
}

/** Most that detail adds, per its strength [–]. */
export const MOST_DETAIL = 2.5

/** Factor of the billows of a column of a strength: weaker where only its top is an edge. */
export const topBillows = (column: Float): Float =>
  smoothstep(...billowForm.middle, column)
    .mix(float(1), billowForm.atTops)
    .toConst()

/**
 * Strength that coarse billows add to a column at a height [–]: they carve all columns, and bulge out of those that nearly reach it. Out
 * of others they would be heads without stems. Twin: layers/meanColumn.ts
 *
 * @param billow - Their strength [–].
 * @param column - Strength of the column [–].
 * @param needed - `neededStrength` at the height [–].
 */
export function bulge(billow: Float, column: Float, needed: Float): Float {
  const lacking = smoothstep(...billowForm.bulgeFrom, column.sub(needed)).oneMinus()
  const share = smoothstep(...billowForm.bulgeAbove, needed)
    .mul(lacking)
    .oneMinus()
  return billow.min(billow.mul(share)).toConst()
}

/** Share of fine billows and detail that a body has, in [0, 1]: dense bodies have them, crumbs do not. */
export const fineShare = (strength: Float): Float =>
  strength.sub(billowForm.fineFrom).div(billowForm.fineOver).add(1).clamp().toConst()
