import { If, smoothstep } from 'three/tsl'
import { billowForm, heightForm } from '../formConstants'
import type { Float } from '../../tsl-types'
import type { LayerNodes } from './layer'

// All that depends on the layer and the height alone. Float64 on the CPU: layers/meanColumn.ts.

/**
 * Strength that a column needs for cloud at a height: 0 at the base, so that bases are flat, and more with
 * every metre, so that tops are as high as their columns are strong. With relief, bases of weak columns are higher. Under an
 * anvil towers are narrow, and spread into it.
 *
 * @param height - ĥ in the layer, in [0, 1].
 * @see Siebesma et al. 2003, "A large eddy simulation intercomparison study of shallow cumulus convection" §4,
 *   on cloud fraction by height
 */
export function neededStrength(layer: LayerNodes, height: Float): Float {
  const above = height.sub(heightForm.inversion).max(0).toConst()
  const below = height.mul(layer.perBaseRelief).oneMinus().max(0).toConst()
  const column = height
    .max(1e-4)
    .pow(layer.profileExponent)
    .mul(heightForm.top)
    .add(above.mul(above).mul(heightForm.inversionStrength))
    .add(below.mul(below).mul(layer.relief))
  const needed = column.toVar() as Float
  If(layer.anvil.greaterThan(0), () => {
    const { tower, towerHeights, anvil, anvilHeights, overshoot } = heightForm
    const towers = smoothstep(...towerHeights, height)
      .oneMinus()
      .mul(tower)
    const end = height
      .sub(anvilHeights[0])
      .max(0)
      .div(1 - anvilHeights[0])
      .toConst()
    const spread = towers.add(anvil).mul(height.mul(8).min(1)).add(end.mul(end).mul(overshoot))
    needed.assign(layer.anvil.mix(needed, spread))
  })
  return needed
}

/** Share of ice at a height of a layer with anvils, in [0, 1]. */
export const iceAt = (layer: LayerNodes, height: Float): Float =>
  layer.anvil.mul(smoothstep(...heightForm.iceHeights, height)).toConst()

/**
 * Extinction at a height over the layer's greatest, in [0, 1]: it grows as droplets of constant number do
 * in rising air, less what mixes in, and ice is thin.
 */
export const densityAtHeight = (layer: LayerNodes, height: Float): Float =>
  height
    .div(heightForm.grown)
    .clamp(1e-4, 1)
    .pow(layer.densityGrowth)
    .mul(iceAt(layer, height).mix(1, heightForm.iceDensity))
    .toConst()

/** Strength of billows at a height, per deviation of their noise: tops are rougher than bases. */
export function billowStrength(
  { shapeAmount, detailAmount }: LayerNodes,
  height: Float
): { coarse: Float; fine: Float; detail: Float } {
  const { coarse, fine, detail, coarseGrowth, fineGrowth, wispHeight } = billowForm
  const growing = (growth: number): Float => height.mul(2 * growth).add(1 - growth)
  const finer = growing(fineGrowth).mul(shapeAmount).toConst()
  // Detail turns over: billows above hang down as wisps at the base.
  const sign = height.div(wispHeight).sub(1).min(1)
  return {
    coarse: growing(coarseGrowth).mul(shapeAmount).mul(coarse).toConst(),
    fine: finer.mul(fine).toConst(),
    detail: finer.mul(detailAmount).mul(sign).mul(detail).toConst()
  }
}

/** Share of turbulence at a height, in [0, 1]: none at the base, or else it would not be flat. */
export const bendAtHeight = (height: Float): Float => height.div(billowForm.bendHeight).min(1)
