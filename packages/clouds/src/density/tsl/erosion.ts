import { If, float, log2, smoothstep, vec3 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { erosionForm } from '../formConstants'
import { NOISE_SIZE } from '../../noise/noiseSizes'
import { latticeRotations } from '../lattice'
import { CURL_AMOUNT, CURL_PERIOD, DETAIL_PERIOD } from '../../layers/layerUniforms'
import { CURL_SCALE } from '../../noise/noiseRecipes'
import type { Float, Vec3 } from '../../tsl-types'
import { rotate, type LayerNodes } from './layer'
import { footprintOf, type CloudSample } from './sample'

/** A variable of a shader. */
type FloatVariable = Float & { subAssign: (n: Float) => void }

/** A place where a layer's noise is looked up. */
export interface NoisePlace {
  /** Displacement from the camera in the layer's frame, shortened along fibres [m]. */
  position: Vec3
  /** Width of what the sample stands for [m]. */
  footprint: Float
}

/** What shape erosion does to a sample. */
export interface Erosion {
  /** Taken from the dimensional profile [–]. */
  eroded: Float
  /** The dimensional profile that is left; below 0 where there is no cloud. */
  left: FloatVariable
}

/** Place of a sample in a layer's noise. */
export function noisePlace(field: CloudField, layer: LayerNodes, sample: CloudSample): NoisePlace {
  const stretch = vec3(layer.perStretch, layer.perStretch, 1)
  const position = layer.mappedToLayer(sample.offset).mul(stretch).toConst() as Vec3
  return { position, footprint: footprintOf(field, sample) }
}

/** Level of detail for a footprint; 0 where texels are wider. */
const levelOf = (footprint: Float, texel: Float | number): Float =>
  log2(footprint.div(texel).max(1e-3)).max(0)

/**
 * Billows of the shape noise: round heads with creases between them, 1 on the heads.
 *
 * Any noise may stand here that is 1 at most and whose mean its levels of detail keep, apart from what
 * `filteredShape` makes up for. It may depend on the layer, the place and the weather's warp, and must
 * not change by 1 within less than `STEEPEST_SHAPE` periods of the shape (tsl/emptyDistance.ts).
 *
 * @see Schneider & Vos 2015, "The real-time volumetric cloudscapes of Horizon: Zero Dawn", "Modeling".
 */
export function billows(
  field: CloudField,
  layer: LayerNodes,
  shapeWarp: Vec3,
  { position, footprint }: NoisePlace
): Float {
  const { shape } = field.textures
  const place = rotate(latticeRotations.shape, position.add(shapeWarp.mul(layer.perStretch))).mul(
    layer.perShapePeriod
  )
  const level = levelOf(footprint, float(1 / NOISE_SIZE.shape).div(layer.perShapePeriod))
  const noise = shape.sample(place.add(layer.shapeAnchor)).level(level).toConst()
  const { finerBillows, fadeLevels, filteredShape } = erosionForm
  return noise.x
    .add(noise.y.sub(0.5).mul(finerBillows))
    .add(smoothstep(0, fadeLevels, level).mul(filteredShape))
}

/**
 * Shape erosion: the creases between billows are carved out of the dimensional profile, at least
 * `leastShape` of the layer's amount of it.
 *
 * @param profile - `dimensionalProfile`.
 */
export function shapeErosion(layer: LayerNodes, profile: Float, billows: Float): Erosion {
  const eroded = layer.shapeAmount
    .mul(billows.oneMinus().max(erosionForm.leastShape))
    .toConst() as Float
  return { eroded, left: profile.sub(eroded).toVar() }
}

/** Most that detail takes away from a layer [–]. */
const mostDetail = (layer: LayerNodes): Float =>
  layer.detailAmount.mul(erosionForm.mostDetail).toConst()

/**
 * Detail noise, stirred by turbulence, in [0, 1].
 *
 * @see Bridson et al. 2007, "Curl-noise for procedural fluid flow", §2.
 */
function stirredDetail(
  field: CloudField,
  layer: LayerNodes,
  detailWarp: Vec3,
  { position, footprint }: NoisePlace
): Float {
  const { detail } = field.textures
  const place = rotate(latticeRotations.detail, position.add(detailWarp.mul(layer.perStretch)))
    .div(DETAIL_PERIOD)
    .add(layer.detailAnchor)
    .toConst()
  const level = levelOf(footprint, DETAIL_PERIOD / NOISE_SIZE.detail).toConst() as Float
  const curl = detail.sample(place.div(CURL_PERIOD)).level(level).yzw
  const stirred = place.add(curl.sub(0.5).mul(CURL_AMOUNT / CURL_SCALE))
  return detail.sample(stirred).level(level).x.toConst()
}

/**
 * Detail erosion: wisps fray the edges low in a layer, and fine billows the tops.
 *
 * It takes from 0 to `mostDetail`, and is looked up at edges alone: deep inside, the most that it takes
 * changes nothing. It may depend on the layer, the place, the height and the weather's warp.
 *
 * @param left - What shape erosion left: changed.
 * @param height - In the layer, in [0, 1].
 */
export function detailErosion(
  field: CloudField,
  layer: LayerNodes,
  detailWarp: Vec3,
  place: NoisePlace,
  height: Float,
  left: FloatVariable
): void {
  const most = mostDetail(layer)
  If(left.greaterThan(0).and(left.lessThan(most.add(layer.sharpness.reciprocal()))), () => {
    const noise = stirredDetail(field, layer, detailWarp, place)
    const isBillowy = smoothstep(...erosionForm.wispHeights, height)
    left.subAssign(most.mul(isBillowy.mix(noise, noise.oneMinus())))
  })
}

/** The mean of `detailErosion`, for samples that see no detail. */
export const meanDetailErosion = (layer: LayerNodes): Float => mostDetail(layer).mul(0.5)
