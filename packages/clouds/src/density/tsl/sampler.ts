import { If, float, int, vec2, vec4 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import type { Float, Int, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { densityAtHeight } from './heightForm'
import { forLayers, heightIn, isWithin, layerAt, type LayerNodes, type LayerRange } from './layer'
import { CAUTION, likelyDistance, NOWHERE } from './likelyDistance'
import { backgroundAlong, clearLayer, type RayWeather } from './rayWeather'
import { footprintOf, subpointOffset, type CloudSample } from './sample'
import { sampleLayer, sampleLayerAt, type SampleOptions } from './sampleLayer'
import { weatherBackground, type PackedBackground } from './weatherBackground'

// The only answer to where the clouds are. `sampleLayerAt` (sampleLayer.ts) goes from a place and the weather's
// background to extinction and strength; pixels, shadows and light differ in which layers they ask, and in
// where they have the background from. Where a field is given (`CloudField.givenExtinction`), it stands in
// place of all weather and noise.

/** Options of the light march: no detail, and the inside of clouds, where its light is. */
const LIT: SampleOptions = { detail: false, unresolved: 'inside' }

/** Background of the weather at a sample itself. */
const backgroundAt = (
  field: CloudField,
  layer: LayerNodes,
  sample: CloudSample
): PackedBackground =>
  weatherBackground(
    field,
    layer,
    subpointOffset(field, sample).toConst(),
    sample,
    footprintOf(field, sample)
  )

/**
 * Extinction of all clouds at a place, in the weather of that very place: what the samplers below come
 * near to, which share its background between places.
 *
 * @param detail - Whether edges have detail.
 * @returns [1/m], at least 0. Twin: test/twins/density.ts
 */
export function cloudExtinction(field: CloudField, sample: CloudSample, detail: boolean): Float {
  const sum = float(0).toVar()
  forLayers(field, index => {
    const layer = layerAt(field, index)
    If(isWithin(layer, heightIn(layer, sample.altitude)), () => {
      const background = backgroundAt(field, layer, sample)
      sum.addAssign(sampleLayer(field, layer, background, sample, { detail }).extinction)
    })
  })
  return sum
}

/** The weather around a place, kept for places nearby: that of the layer which is densest there. */
export interface WeatherCache {
  readonly background: Vec4
  /** The layer's index. */
  readonly layer: Int
}

/** Two samples of all clouds near each other. */
export interface SamplePair {
  /** At the first and at the second place [1/m]. */
  readonly extinction: Vec2
  /** Distance from either in which there is likely no cloud; 0 in clouds [m]. */
  readonly likelyDistance: Float
  /** Greatest extinction that clouds have at their height [1/m]. */
  readonly greatest: Float
  readonly weather: WeatherCache
}

/**
 * Samples clouds at two places near each other on a ray, with detail.
 *
 * @param kept - Weather along the ray: is looked up where it is not known yet.
 * @param middle - Distance between both places [m]; all have to be within the altitudes of the same layers.
 * @param samples - At the two places.
 * @param sampleAt - The ray's sample at a distance.
 * @param direction - Direction of the ray, in the mapped space.
 * @param range - The layers that are looked at.
 */
export function samplePair(
  field: CloudField,
  kept: RayWeather,
  middle: Float,
  samples: readonly [CloudSample, CloudSample],
  sampleAt: (distance: Float) => CloudSample,
  direction: Vec3,
  range: LayerRange
): SamplePair {
  const { givenExtinction } = field
  if (givenExtinction) {
    const [first, second] = samples.map(sample => givenExtinction(sample.offset))
    const extinction = vec2(first, second).toConst() as Vec2
    const weather = { background: vec4(0) as Vec4, layer: int(0) as Int }
    return { extinction, likelyDistance: float(0), greatest: first.max(second), weather }
  }
  const sum = vec2(0).toVar() as Vec2
  const nearest = float(NOWHERE).toVar()
  const background = vec4(0).toVar() as Vec4
  const densest = int(0).toVar() as Int
  const most = float(0).toVar()
  const greatest = float(0).toVar()
  const { altitude } = sampleAt(middle)
  const isAlone = range.last.sub(range.first).lessThan(int(2)).toConst()
  const end = samples[1].distance
  const look = (index: Int): void => {
    const layer = layerAt(field, index)
    const height = heightIn(layer, altitude)
    const clear = clearLayer(kept, index)
    const isNear = clear.until.lessThan(end).toConst()
    If(isWithin(layer, height).and(isNear.not()), () => {
      nearest.assign(nearest.min(clear.until.sub(end)))
    })
    If(isWithin(layer, height).and(isNear), () => {
      greatest.assign(greatest.max(layer.density.mul(densityAtHeight(layer, height))))
      const here = backgroundAlong(field, kept, layer, index, isAlone, middle, sampleAt)
      const options = { detail: true, direction }
      const [first, second] = sampleLayerAt(field, layer, here, samples, options)
      const found = vec2(first.extinction, second.extinction).toConst() as Vec2
      const likely = likelyDistance(layer, first.strength.max(second.strength)).toConst() as Float
      clear.assign(likely.greaterThan(0).select(end.add(likely.mul(CAUTION)), 0))
      nearest.assign(nearest.min(likely))
      sum.addAssign(found)
      const both = found.x.add(found.y).toConst() as Float
      If(both.greaterThan(most), () => {
        most.assign(both)
        background.assign(here)
        densest.assign(index)
      })
    })
  }
  forLayers(field, look, range)
  const weather = { background, layer: densest }
  return { extinction: sum, likelyDistance: nearest, greatest, weather }
}

/**
 * Extinction near a place whose weather was kept, of its densest layer, without detail [1/m]. Good as far as
 * the weather on large scales is the same. Unresolved clouds have that inside of them: what light meets
 * there is not their mean.
 */
export function extinctionNearby(
  field: CloudField,
  { background, layer: kept }: WeatherCache,
  sample: CloudSample
): Float {
  if (field.givenExtinction) return field.givenExtinction(sample.offset)
  const layer = layerAt(field, field.layers.length === 1 ? int(0) : kept)
  const height = heightIn(layer, sample.altitude)
  const extinction = float(0).toVar()
  If(height.greaterThan(0).and(height.lessThan(1)), () => {
    extinction.assign(sampleLayer(field, layer, background, sample, LIT).extinction)
  })
  return extinction
}

/**
 * Samples a layer at two places near each other, without detail, in the weather's background in the middle
 * between them.
 *
 * @returns Extinction at both [1/m].
 */
export function sampleLayerPair(
  field: CloudField,
  layer: LayerNodes,
  middle: CloudSample,
  samples: readonly [CloudSample, CloudSample]
): Vec2 {
  const { givenExtinction } = field
  if (givenExtinction) {
    const [first, second] = samples.map(sample => givenExtinction(sample.offset))
    return vec2(first, second).toConst()
  }
  const background = backgroundAt(field, layer, middle)
  const found = sampleLayerAt(field, layer, background, samples, { detail: false })
  const [first, second] = samples.map(({ altitude }, i) =>
    isWithin(layer, heightIn(layer, altitude)).select(found[i].extinction, 0)
  )
  return vec2(first, second).toConst()
}
