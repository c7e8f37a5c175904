import { If, float, smoothstep } from 'three/tsl'
import { strengthForm } from '../formConstants'
import { noisePeriods, REGION_SIZE, scaleWeights } from '../../layers/layerUniforms'
import { NOISE_SIZE } from '../../noise/noiseSizes'
import type { Float } from '../../tsl-types'
import { levelOf } from './billows'
import type { LayerNodes } from './layer'

/** Levels of detail at which a footprint is looked up, and what they lose. */
export interface Resolution {
  /** Width of what a sample stands for [m]. */
  readonly footprint: Float
  /** Levels of detail of the shape and of the weather's noise [octaves]. */
  readonly shapeLevel: Float
  readonly weatherLevel: Float
  /** Unresolved fraction: 0 where samples resolve single clouds, 1 where they see their mean only. */
  readonly unresolvedFraction: Float
  /** Variance of the weather's sum that is lost, and the factor that makes up for it [–]. */
  readonly lostVariance: Float
  readonly gain: Float
  /** Share of the variance of single clouds that is lost, in [0, 1]. */
  readonly cloudsLost: Float
  /** Share of the billows that is lost, in [0, 1]. */
  readonly billowsLost: Float
}

/** Level of detail of the weather's noise for a footprint, looked up with a period [m]. */
export const weatherLevel = (footprint: Float, perPeriod: Float | number): Float =>
  levelOf(footprint.mul(perPeriod), 1 / NOISE_SIZE.weather)
    .mul(strengthForm.levelsPerOctave)
    .toConst()

/**
 * Levels of detail over which single clouds pass into their mean: the first and the last. Smaller: clouds blur
 * nearer to the camera; greater: far ones flicker (*Cockpit*).
 */
const UNRESOLVED_LEVELS = [0.5, 4.5] as const

/** Share of a noise's variance that its levels of detail have lost. */
const lostShare = (level: Float): Float => smoothstep(0, strengthForm.fadeLevels, level)

/** Variance of the weather's sum that levels of detail have lost: none near by. */
function lostVariance(layer: LayerNodes, footprint: Float, level: Float, cloudLevel: Float): Float {
  const regionVariance = layer.regions.mul(layer.regions).mul(REGION_SIZE ** 2 / 12)
  const mesoscaleVariance = layer.mesoscale
    .mul(layer.mesoscale)
    .mul((1 + scaleWeights.bands ** 2) / 12)
  const fieldVariance = layer.cloudVariance
    .add(layer.planet.mul(layer.planet))
    .add(mesoscaleVariance)
    .add(regionVariance)
    .oneMinus()
  const fieldLevel = level.sub(strengthForm.levelsPerOctave * Math.log2(noisePeriods.fields)).max(0)
  const mesoscaleLevel = weatherLevel(footprint, 1 / noisePeriods.mesoscale)
  const regionLevel = weatherLevel(footprint, 1 / noisePeriods.regions)
  return layer.cloudVariance
    .mul(lostShare(cloudLevel))
    .add(fieldVariance.mul(lostShare(fieldLevel.sub(0.5))))
    .add(mesoscaleVariance.mul(lostShare(mesoscaleLevel.sub(0.8))))
    .add(regionVariance.mul(lostShare(regionLevel.sub(0.8))))
}

/**
 * Resolution of a layer's samples of a footprint. To be called inside of a shader function.
 *
 * @param billowFootprints - Footprints by which billows are looked up; left out where none are.
 */
export function resolutionAt(
  layer: LayerNodes,
  footprint: Float,
  billowFootprints = 1
): Resolution {
  const level = weatherLevel(footprint, layer.perWeatherPeriod)
  const width = footprint.mul(layer.perShapePeriod).mul(billowFootprints)
  const shapeLevel = levelOf(width, 1 / NOISE_SIZE.shape)
  const cloudLevel = level
    .sub(layer.coarseness.mul(strengthForm.levelsPerOctave))
    .toConst() as Float
  const variance = float(0).toVar()
  const gain = float(1).toVar()
  If(level.greaterThan(0), () => {
    variance.assign(lostVariance(layer, footprint, level, cloudLevel))
    gain.assign(variance.oneMinus().max(strengthForm.leastVariance).inverseSqrt())
  })
  return {
    footprint,
    shapeLevel,
    weatherLevel: level,
    unresolvedFraction: smoothstep(...UNRESOLVED_LEVELS, cloudLevel).toConst(),
    lostVariance: variance,
    gain,
    cloudsLost: lostShare(cloudLevel).toConst(),
    billowsLost: smoothstep(...strengthForm.billowLevels, shapeLevel).toConst()
  }
}
