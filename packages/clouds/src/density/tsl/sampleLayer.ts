import { If, float } from 'three/tsl'
import type { CloudField } from '../CloudField'
import type { Float, Vec3 } from '../../tsl-types'
import { emptyDistanceByShape, emptyDistanceByWeather, surelyEroded } from './emptyDistance'
import { billows, detailErosion, meanDetailErosion, noisePlace, shapeErosion } from './erosion'
import { edgeDensity, extinctionAt } from './extinction'
import type { LayerNodes } from './layer'
import { dimensionalProfile, layerHeight } from './profile'
import type { CloudSample } from './sample'
import { mixedDensity, unresolvedDensity, type Unresolved } from './unresolved'
import type { CloudWeather } from './weather'

/** A layer at a place. */
export interface LayerSample {
  /** Extinction [1/m], at least 0. */
  readonly extinction: Float
  /** Distance in which there is nothing of the layer, within its altitudes; 0 in clouds [m]. */
  readonly emptyDistance: Float
}

/** Options of {@link sampleLayer}. */
export interface SampleOptions {
  /** Detail erosion of the edges, or its mean: clouds keep their size. */
  readonly detail: boolean
  /** Meaning of unresolved clouds; by default their mean. */
  readonly unresolved?: Unresolved
  /** Direction of the ray on which they are met, in the mapped space; left out, straight up. */
  readonly direction?: Vec3
}

/**
 * One layer at a place in a given weather: weather → dimensional profile → shape erosion → detail erosion
 * → extinction and empty distance.
 *
 * @param height - In the layer, in (0, 1).
 */
export function sampleLayer(
  field: CloudField,
  layer: LayerNodes,
  weather: CloudWeather,
  sample: CloudSample,
  height: Float,
  { detail, unresolved = 'mean', direction }: SampleOptions
): LayerSample {
  const at = layerHeight(layer, height)
  const profile = dimensionalProfile(layer, weather.strength, at)
  const density = float(0).toVar()
  const least = surelyEroded(layer).toConst() as Float
  const emptyDistance = emptyDistanceByWeather(layer, weather).toVar() as Float
  If(profile.greaterThan(least), () => {
    const place = noisePlace(field, layer, sample)
    const heads = billows(field, layer, weather.shapeWarp, place)
    const { eroded, left } = shapeErosion(layer, profile, heads)
    if (detail) detailErosion(field, layer, weather.detailWarp, place, height, left)
    density.assign(edgeDensity(layer, detail ? left : left.sub(meanDetailErosion(layer))))
    emptyDistance.assign(emptyDistanceByShape(layer, weather, eroded))
  })
  const { unresolvedFraction, filteredCoverage } = weather
  If(unresolvedFraction.mul(filteredCoverage).greaterThan(0), () => {
    const cosine = direction?.dot(sample.up).toConst() as Float | undefined
    const mean = unresolvedDensity(field, layer, weather, at, unresolved, cosine)
    density.assign(mixedDensity(mean.columnDepth, density, mean.density, unresolvedFraction))
    emptyDistance.assign(float(0))
  })
  return {
    extinction: extinctionAt(layer, density, at),
    emptyDistance: emptyDistance.max(0).toConst()
  }
}
