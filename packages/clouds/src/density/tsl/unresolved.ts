import { float } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../CloudField'
import { columnForm, heightForm, strengthForm } from '../formConstants'
import type { Float } from '../../tsl-types'
import { iceAt, neededStrength } from './heightForm'
import type { LayerNodes } from './layer'
import { squared } from './squared'
import { isStorm } from './storm'

// Clouds too small or too far to be seen one by one, as mean columns that let the same light through.
// Integrals over columns and heights come from the CPU: layers/meanColumn.ts.

/** Mean density of a cloudy column, over the layer's: clouds that have grown together are thicker [–]. */
export const columnDensityAt = (layer: LayerNodes, filteredCoverage: Float): Float =>
  squared(filteredCoverage, 5).mix(layer.columnDensity, layer.fullDensity)

/** Vertical optical depth of a cloud, as it counts in the light that comes through. */
const columnOpticalDepth = (
  { depthScale }: CloudField,
  layer: LayerNodes,
  filteredCoverage: Float
): Float =>
  layer.density
    .mul(layer.thickness)
    .mul(columnDensityAt(layer, filteredCoverage))
    .mul(depthScale)
    .max(1e-4)
    .toConst()

/**
 * Effective optical depth: that of an even layer which takes as much light as the clouds and gaps of a
 * sample's footprint do.
 *
 * @param filteredCoverage - Share of the footprint that is covered, in [0, 1].
 */
export function effectiveOpticalDepth(
  field: CloudField,
  layer: LayerNodes,
  filteredCoverage: Float
): Float {
  const blocked = filteredCoverage.mul(
    columnOpticalDepth(field, layer, filteredCoverage).negate().exp().oneMinus()
  )
  // Thick clouds let nothing through, in float32.
  return blocked.oneMinus().max(1e-30).log().negate().div(field.depthScale).toConst()
}

/**
 * Least cosine between a ray and the zenith by which clouds are taken to hide more. Smaller: an opaque line
 * at the horizon (*Cockpit*).
 */
const LEAST_COSINE = 0.05

/**
 * Slant-cover factor: how much more of the sky a layer's clouds hide along a ray than straight up, as a
 * factor of their effective optical depth. Tall ones are seen from the side as well, flat ones are not.
 *
 * @param cosine - Between the ray and the zenith.
 */
export function slantCoverFactor(layer: LayerNodes, cosine: Float): Float {
  const { slantAspect } = columnForm
  const { slantOfStorms } = columnForm
  const share = select(isStorm(layer), float(slantOfStorms), float(1)) as Float
  const tall = layer.thickness.mul(layer.perWeatherPeriod).mul(slantAspect).min(1).mul(share)
  return tall.mix(1, cosine.abs().max(LEAST_COSINE).reciprocal())
}

/**
 * Share of cloudy columns that are seen at a height, in [0, 1]: more than those that reach it, since what one sees
 * of clouds from afar are their tops.
 */
const seenShare = (layer: LayerNodes, height: Float): Float =>
  neededStrength(layer, height)
    .div(strengthForm.strongest)
    .oneMinus()
    .mul(columnForm.tops)
    .clamp()
    .mul(
      height
        .div(layer.anvil.mix(columnForm.hiddenBelow, columnForm.hiddenByAnvil))
        .clamp(columnForm.leastSeen, 1)
    )
    .toConst()

/** Meaning of a sample of unresolved clouds: their mean over the sky, or the inside of one. */
export type Unresolved = 'mean' | 'inside'

/**
 * Density of unresolved clouds at a height, over the layer's [–].
 *
 * @param filteredCoverage - Share of the footprint that is covered, in [0, 1].
 * @param cosine - Between the ray on which they are met and the zenith; left out, it goes straight up.
 */
export function unresolvedDensity(
  field: CloudField,
  layer: LayerNodes,
  filteredCoverage: Float,
  height: Float,
  unresolved: Unresolved,
  cosine?: Float
): { density: Float; columnDepth: Float } {
  const whole =
    unresolved === 'mean'
      ? effectiveOpticalDepth(field, layer, filteredCoverage)
          .mul(layer.perThickness)
          .div(layer.density.max(1e-9))
      : layer.insideDensity
  const profile = seenShare(layer, height).div(layer.profileMean)
  // Light from low down crosses the thin rims of anvils.
  const thin = iceAt(layer, height).mix(1, heightForm.iceDensity)
  const shape = unresolved === 'inside' ? profile.mul(thin).mul(columnForm.inside) : profile
  const columnDepth = columnOpticalDepth(field, layer, filteredCoverage)
  const slant = cosine === undefined ? float(1) : slantCoverFactor(layer, cosine).mul(cosine.abs())
  return { density: whole.mul(shape).mul(slant).toConst(), columnDepth }
}

/** Density between two, such that the light is mixed that columns of them let through. */
export function mixedDensity(columnDepth: Float, a: Float, b: Float, share: Float): Float {
  const through = share.mix(a.mul(columnDepth).negate().exp(), b.mul(columnDepth).negate().exp())
  return through.max(1e-30).log().negate().div(columnDepth)
}
