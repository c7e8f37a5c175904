import { anvilForm } from '../formConstants'
import type { Float } from '../../tsl-types'
import type { LayerNodes } from './layer'
import type { LayerHeight } from './profile'

/**
 * Density that erosion leaves: 0 at the edge of a cloud, 1 from `1 / sharpness` of dimensional profile
 * inward.
 *
 * @param left - Dimensional profile less erosion.
 */
export const edgeDensity = (layer: LayerNodes, left: Float): Float =>
  left.mul(layer.sharpness).clamp(0, 1)

/**
 * Extinction of a density in a layer at a height [1/m]. Anvils are thin.
 *
 * It may depend on the layer and the height alone, and must not exceed the layer's density: mean columns
 * (`meanColumnDensity`, `profileMean` of tsl/unresolved.ts) stand for its integral.
 */
export const extinctionAt = (layer: LayerNodes, density: Float, { anvil }: LayerHeight): Float =>
  layer.density.mul(density).mul(anvil.mix(1, anvilForm.density)).toConst()
