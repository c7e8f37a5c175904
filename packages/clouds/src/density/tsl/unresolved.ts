import { float, smoothstep } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { anvilForm, columnForm } from '../formConstants'
import type { Float } from '../../tsl-types'
import type { LayerNodes } from './layer'
import type { LayerHeight } from './profile'
import { squared } from './squared'
import type { CloudWeather } from './weather'

// Clouds too small or too far to be seen one by one, as mean columns that let the same light through.

/** Weather as far as mean columns need it. */
type Coverage = Pick<CloudWeather, 'filteredCoverage'>

/** Mean density of a cloudy column over the densest [–]. */
export function meanColumnDensity(layer: LayerNodes, { filteredCoverage }: Coverage): Float {
  const [least, more, most] = columnForm.fibrousDensity
  const square = squared(filteredCoverage, 1)
  const fibres = square.mul(more).add(squared(square, 5).mul(most)).add(least)
  const solid = layer.anvil.mix(columnForm.density, columnForm.anvilDensity)
  return layer.fibrous.mix(solid, fibres).toConst()
}

/** Vertical optical depth of a cloud, as it counts in the light that comes through. */
const columnOpticalDepth = (
  { depthScale }: CloudField,
  layer: LayerNodes,
  weather: Coverage
): Float =>
  layer.density
    .mul(layer.thickness)
    .mul(meanColumnDensity(layer, weather))
    .mul(depthScale)
    .max(1e-4)
    .toConst()

/**
 * Effective optical depth: that of an even layer which takes as much light as the clouds and gaps of a
 * sample's footprint do.
 */
export function effectiveOpticalDepth(
  field: CloudField,
  layer: LayerNodes,
  weather: Coverage,
  columnDepth = columnOpticalDepth(field, layer, weather)
): Float {
  const blocked = weather.filteredCoverage.mul(columnDepth.negate().exp().oneMinus())
  // Thick clouds let nothing through, in float32.
  return blocked.oneMinus().max(1e-30).log().negate().div(field.depthScale).toConst()
}

/** Mean of `heightProfile` over a layer's heights, times the density of anvils. */
function profileMean(layer: LayerNodes): Float {
  const e = layer.profileExponent
  const mean = e.mul(4).div(e.add(1).mul(e.mul(2).add(1)))
  return layer.anvil.mix(mean, anvilForm.profileMean)
}

/** Least cosine between a ray and the zenith by which clouds are taken to hide more. */
const LEAST_COSINE = 0.05

/**
 * Slant-cover factor: how much more of the sky a layer's clouds hide along a ray than straight up, as a
 * factor of their effective optical depth. Tall ones are seen from the side as well, flat ones are not.
 *
 * @param cosine - Between the ray and the zenith.
 */
export function slantCoverFactor(layer: LayerNodes, cosine: Float): Float {
  const { slantAspect } = columnForm
  const tall = layer.thickness.mul(layer.perWeatherPeriod).mul(slantAspect).min(1)
  return tall.mix(1, cosine.abs().max(LEAST_COSINE).reciprocal())
}

/** What a sample of unresolved clouds stands for: their mean over the sky, or the inside of one. */
export type Unresolved = 'mean' | 'inside'

/**
 * Density of unresolved clouds at a height, over the layer's [–].
 *
 * @param cosine - Between the ray on which they are met and the zenith; left out, it goes straight up.
 */
export function unresolvedDensity(
  field: CloudField,
  layer: LayerNodes,
  weather: Coverage,
  { height, profile }: LayerHeight,
  unresolved: Unresolved,
  cosine?: Float
): { density: Float; columnDepth: Float } {
  // Towers with anvils are seen from afar as these.
  const { anvil } = layer
  const towers = profile.mul(anvil.mix(1, smoothstep(...anvilForm.heights, height)))
  const whole =
    unresolved === 'mean'
      ? effectiveOpticalDepth(field, layer, weather)
          .mul(layer.perThickness)
          .div(layer.density.mul(profileMean(layer)).max(1e-9))
      : meanColumnDensity(layer, weather).max(anvil)
  const columnDepth = columnOpticalDepth(field, layer, weather)
  const slant = cosine === undefined ? float(1) : slantCoverFactor(layer, cosine).mul(cosine.abs())
  return { density: whole.mul(towers).mul(slant).toConst(), columnDepth }
}

/** Density between two, such that the light is mixed that columns of them let through. */
export function mixedDensity(columnDepth: Float, a: Float, b: Float, share: Float): Float {
  const through = share.mix(a.mul(columnDepth).negate().exp(), b.mul(columnDepth).negate().exp())
  return through.max(1e-30).log().negate().div(columnDepth)
}
