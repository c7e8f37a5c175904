import { If, float, int, vec2, vec3, vec4 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import type { Float, Int, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { emptyDistanceByWeather, mayHoldCloud, NOWHERE } from './emptyDistance'
import { forLayers, heightIn, isWithin, layerAt, type LayerNodes, type LayerRange } from './layer'
import { subpointOffset, type CloudSample } from './sample'
import { sampleLayer, type SampleOptions } from './sampleLayer'
import { weatherAt, type CloudWeather } from './weather'

// The only answer to where the clouds are. `sampleLayer` (sampleLayer.ts) goes from a place and its weather
// to extinction and empty distance; pixels, shadows, light and the cone prepass differ in which layers they
// ask, and in where they have the weather from. Where a field is given (`CloudField.givenExtinction`), it
// stands in place of all weather and noise.

/** Options of the light march: no detail, and the inside of clouds, where its light is. */
const LIT: SampleOptions = { detail: false, unresolved: 'inside' }

/**
 * Extinction of all clouds at a place, in the weather of that very place: what the samplers below come
 * near to, which share weather between places.
 *
 * @param detail - Whether edges are eroded by detail.
 * @returns [1/m], at least 0. Twin: test/twins/density.ts
 */
export function cloudExtinction(field: CloudField, sample: CloudSample, detail: boolean): Float {
  const sum = float(0).toVar()
  const subpoint = subpointOffset(field, sample).toConst()
  forLayers(field, index => {
    const layer = layerAt(field, index)
    const height = heightIn(layer, sample.altitude)
    If(isWithin(layer, height), () => {
      const weather = weatherAt(field, layer, subpoint, sample, 'where unresolved')
      sum.addAssign(sampleLayer(field, layer, weather, sample, height, { detail }).extinction)
    })
  })
  return sum
}

/** The weather of a place, kept for places nearby: that of the layer which is densest there. */
export interface WeatherCache {
  /** Strength, filtered coverage and unresolved fraction of `CloudWeather`, and the layer's index. */
  readonly values: Vec4
  readonly shapeWarp: Vec3
}

/** Two samples of all clouds near each other. */
export interface SamplePair {
  /** At the first and at the second place [1/m]. */
  readonly extinction: Vec2
  /** From the second, if there is no cloud at either: see `LayerSample` [m]. */
  readonly emptyDistance: Float
  readonly weather: WeatherCache
}

/**
 * Samples clouds at two places near each other on a ray, with detail, in the weather in the middle between
 * them: looking that up takes longer than the rest, and it is kilometres wide.
 *
 * @param middle - All three have to be within the altitudes of the same layers.
 * @param samples - Make the samples, where they are needed.
 * @param direction - Direction of the ray, in the mapped space.
 * @param range - The layers that are looked at.
 */
export function samplePair(
  field: CloudField,
  middle: CloudSample,
  samples: readonly (() => CloudSample)[],
  direction: Vec3,
  range: LayerRange
): SamplePair {
  const { givenExtinction } = field
  if (givenExtinction) {
    const [first, second] = samples.map(sampleAt => givenExtinction(sampleAt().offset))
    const extinction = vec2(first, second).toConst() as Vec2
    return { extinction, emptyDistance: float(0), weather: { values: vec4(0), shapeWarp: vec3(0) } }
  }
  const sum = vec2(0).toVar() as Vec2
  const emptyDistance = float(NOWHERE).toVar()
  const values = vec4(0).toVar() as Vec4
  const shapeWarp = vec3(0).toVar() as Vec3
  const most = float(0).toVar()
  const subpoint = subpointOffset(field, middle).toConst()
  const keepDensest = (index: Int, weather: CloudWeather, found: Vec2): void => {
    const both = found.x.add(found.y).toConst() as Float
    If(both.greaterThan(most), () => {
      const { strength, filteredCoverage, unresolvedFraction } = weather
      most.assign(both)
      values.assign(vec4(strength, filteredCoverage, unresolvedFraction, float(index)))
      shapeWarp.assign(weather.shapeWarp)
    })
  }
  const look = (index: Int): void => {
    const layer = layerAt(field, index)
    If(isWithin(layer, heightIn(layer, middle.altitude)), () => {
      const weather = weatherAt(field, layer, subpoint, middle, 'where unresolved')
      const found = vec2(0).toVar() as Vec2
      const empty = emptyDistanceByWeather(layer, weather).toVar() as Float
      If(mayHoldCloud(layer, weather), () => {
        samples.forEach((sampleAt, i) => {
          const sample = sampleAt()
          const height = heightIn(layer, sample.altitude)
          const options = { detail: true, direction }
          const one = sampleLayer(field, layer, weather, sample, height, options)
          found.addAssign(i === 0 ? vec2(one.extinction, 0) : vec2(0, one.extinction))
          if (i === 1) empty.assign(one.emptyDistance)
        })
      })
      emptyDistance.assign(emptyDistance.min(empty))
      sum.addAssign(found)
      keepDensest(index, weather, found)
    })
  }
  forLayers(field, look, range)
  return { extinction: sum, emptyDistance, weather: { values, shapeWarp } }
}

/**
 * Extinction near a place whose weather was kept, of its densest layer, without detail [1/m]: a single
 * texture read. Good as far as the weather is the same. Unresolved clouds have that inside of them: what
 * light meets there is not their mean.
 */
export function extinctionNearby(
  field: CloudField,
  { values, shapeWarp }: WeatherCache,
  sample: CloudSample
): Float {
  if (field.givenExtinction) return field.givenExtinction(sample.offset)
  const isOne = field.layers.length === 1
  const layer = layerAt(field, isOne ? int(0) : values.w.toInt())
  const height = heightIn(layer, sample.altitude)
  const extinction = float(0).toVar()
  If(height.greaterThan(0).and(height.lessThan(1)), () => {
    const weather = {
      strength: values.x,
      filteredCoverage: values.y,
      unresolvedFraction: values.z,
      shapeWarp,
      detailWarp: shapeWarp
    }
    extinction.assign(sampleLayer(field, layer, weather, sample, height, LIT).extinction)
  })
  return extinction
}

/**
 * Samples a layer at two places near each other, without detail, in the weather in the middle between
 * them.
 *
 * @param add - Takes each sample's extinction [1/m].
 */
export function sampleLayerPair(
  field: CloudField,
  layer: LayerNodes,
  middle: CloudSample,
  samples: readonly [CloudSample, CloudSample],
  add: (extinction: Float, index: number) => void
): void {
  const { givenExtinction } = field
  if (givenExtinction) {
    samples.forEach((sample, i) => add(givenExtinction(sample.offset), i))
    return
  }
  const subpoint = subpointOffset(field, middle).toConst()
  const weather = weatherAt(field, layer, subpoint, middle, 'where unresolved')
  samples.forEach((sample, i) => {
    const height = heightIn(layer, sample.altitude)
    If(isWithin(layer, height), () => {
      add(sampleLayer(field, layer, weather, sample, height, { detail: false }).extinction, i)
    })
  })
}

/** Empty distance of a place: no cloud of any layer is nearer, whatever the noise [m]. */
export function emptyDistanceAt(field: CloudField, sample: CloudSample): Float {
  if (field.givenExtinction) return float(0)
  const emptyDistance = float(NOWHERE).toVar()
  const subpoint = subpointOffset(field, sample).toConst()
  forLayers(field, index => {
    const layer = layerAt(field, index)
    If(layer.coverage.greaterThan(0), () => {
      const weather = weatherAt(field, layer, subpoint, sample, 'where unresolved')
      const isResolved = weather.unresolvedFraction.mul(weather.filteredCoverage).equal(0)
      const { altitude } = sample
      const { baseAltitude, thickness } = layer
      const apart = baseAltitude.sub(altitude).max(altitude.sub(baseAltitude).sub(thickness))
      const empty = isResolved.select(emptyDistanceByWeather(layer, weather), 0).max(apart)
      emptyDistance.assign(emptyDistance.min(empty))
    })
  })
  return emptyDistance
}
