import { If, float, int, mix, vec2, vec4 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import type { WeatherMap } from '../WeatherMap'
import type { Float, Int, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { densityAtHeight } from './heightForm'
import {
  forEachLayer,
  forLayers,
  heightIn,
  isWithin,
  layerAt,
  type LayerNodes,
  type LayerRange
} from './layer'
import { CAUTION, likelyDistance, NOWHERE } from './likelyDistance'
import { footprintOf, subpointOffset, type CloudSample } from './sample'
import { sampleLayer, sampleLayerAt, type SampleOptions } from './sampleLayer'
import { weatherBackground, type PackedBackground } from './weatherBackground'

// The only answer to where the clouds are. `sampleLayerAt` (sampleLayer.ts) goes from a place and the weather's
// background to extinction and strength; pixels, shadows and light differ in which layers they ask, and in
// where they have the background from. Where a field is given (`CloudField.givenExtinction`), it stands in
// place of all weather and noise.

/** Options of the light march: no detail, and the inside of clouds, where its light is. */
const LIT: SampleOptions = { detail: false, unresolved: 'inside' }

/** Background of the weather at a sample: from a map, or looked up at the place itself. */
function backgroundAt(
  field: CloudField,
  layer: LayerNodes,
  sample: CloudSample,
  mapped?: { map: WeatherMap | undefined; index: Int }
): PackedBackground {
  const subpoint = subpointOffset(field, sample).toConst() as Vec3
  const footprint = footprintOf(field, sample)
  const { map, index } = mapped ?? {}
  return map === undefined || index === undefined
    ? weatherBackground(field, layer, subpoint, sample, footprint)
    : map.sample(layer, index, subpoint, sample.up, footprint)
}

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
  readonly background: PackedBackground
  /** The layer's index. */
  readonly layer: Int
}

/** Weather around a place in the clouds. */
export function weatherCacheAt(
  field: CloudField,
  sample: CloudSample,
  range: LayerRange,
  map?: WeatherMap
): WeatherCache {
  const background = vec4(0).toVar() as Vec4
  const densest = int(0).toVar() as Int
  if (field.givenExtinction) return { background, layer: densest }
  const most = float(-1).toVar()
  forLayers(
    field,
    index => {
      const layer = layerAt(field, index)
      If(isWithin(layer, heightIn(layer, sample.altitude)), () => {
        const found = backgroundAt(field, layer, sample, { map, index })
        if (field.layers.length === 1) {
          background.assign(found)
          return
        }
        const { extinction } = sampleLayer(field, layer, found, sample, LIT)
        If(extinction.greaterThan(most), () => {
          most.assign(extinction)
          background.assign(found)
          densest.assign(index)
        })
      })
    },
    range
  )
  return { background, layer: densest }
}

/**
 * Likely distance to cloud in the clear air of a given field [m], of which nothing more is known: steps are
 * `CAUTION` of it, about a cell of simulated ones.
 */
const CLEAR_OF_GIVEN = 100

/** Two samples of all clouds near each other. */
export interface SamplePair {
  /** At the first and at the second place [1/m]. */
  readonly extinction: Vec2
  /** Distance from either in which there is likely no cloud; 0 in clouds [m]. */
  readonly likelyDistance: Float
  /** Greatest extinction that clouds have at their height [1/m]. */
  readonly greatest: Float
}

/** Distances up to which each layer is likely clear [m]: rarer layers are not looked at with every sample of others. */
export type ClearLayers = Vec4 & { assign: (n: Vec4) => void }

/** A sample near another, on a straight line through it [m]: for its level of detail it is as far away. */
const sampleNearby = (
  { offset, altitude, up, distance }: CloudSample,
  direction: Vec3,
  along: Float
): CloudSample => ({
  offset: offset.add(direction.mul(along)).toConst(),
  altitude: altitude.add(direction.dot(up).mul(along)).toConst(),
  up,
  distance
})

/**
 * Samples clouds at two places near each other on a ray, with detail.
 *
 * @param map - Weather around the camera; left out, it is looked up at the place itself.
 * @param clear - Is kept between samples of a ray.
 * @param middle - The place between both, within the altitudes of the same layers.
 * @param length - Distance between them [m].
 * @param direction - Direction of the ray, in the mapped space.
 * @param range - The layers that are looked at.
 */
export function samplePair(
  field: CloudField,
  map: WeatherMap | undefined,
  clear: ClearLayers,
  middle: CloudSample,
  length: Float,
  direction: Vec3,
  range: LayerRange
): SamplePair {
  const { givenExtinction } = field
  const places = [-0.5, 0.5].map(at => sampleNearby(middle, direction, length.mul(at)))
  if (givenExtinction) {
    const [first, second] = places.map(({ offset }) => givenExtinction(offset))
    const extinction = vec2(first, second).toConst() as Vec2
    const likelyDistance = first.max(second).greaterThan(0).select(0, CLEAR_OF_GIVEN)
    return { extinction, likelyDistance, greatest: layerAt(field, int(0)).density }
  }
  const sum = vec2(0).toVar() as Vec2
  const nearest = float(NOWHERE).toVar()
  const greatest = float(0).toVar()
  const end = middle.distance.add(length.mul(0.5)).toConst()
  const isAlone = field.layers.length === 1
  const look = (index: Int): void => {
    const layer = layerAt(field, index)
    const height = heightIn(layer, middle.altitude)
    /** 1 in the layer's component, 0 in the others. */
    const own = vec4(0, 1, 2, 3).sub(float(index)).abs().min(1).oneMinus().toConst() as Vec4
    const clearUntil = isAlone ? float(0) : clear.dot(own).toConst()
    const isNear = clearUntil.lessThan(end).toConst()
    If(isWithin(layer, height).and(isNear.not()), () => {
      nearest.assign(nearest.min(clearUntil.sub(end)))
    })
    If(isWithin(layer, height).and(isNear), () => {
      greatest.assign(greatest.max(layer.density.mul(densityAtHeight(layer, height))))
      const background = backgroundAt(field, layer, middle, { map, index })
      const options = { detail: true, direction }
      const [first, second] = sampleLayerAt(field, layer, background, middle, places, options)
      const likely = likelyDistance(layer, first.strength.max(second.strength)).toConst() as Float
      if (!isAlone) {
        const until = likely.greaterThan(0).select(end.add(likely.mul(CAUTION)), 0)
        clear.assign(mix(clear, vec4(until), own))
      }
      nearest.assign(nearest.min(likely))
      sum.addAssign(vec2(first.extinction, second.extinction))
    })
  }
  forEachLayer(field, look, range)
  return { extinction: sum, likelyDistance: nearest, greatest }
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
  const found = sampleLayerAt(field, layer, background, middle, samples, { detail: false })
  const [first, second] = samples.map(({ altitude }, i) =>
    isWithin(layer, heightIn(layer, altitude)).select(found[i].extinction, 0)
  )
  return vec2(first, second).toConst()
}
