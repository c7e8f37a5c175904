import { If, float, int, vec2, vec4 } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../CloudField'
import { hasStorms } from '../kinds'
import type { WeatherMap } from '../WeatherMap'
import type { Bool, Float, Int, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { forLayers, heightIn, isWithin, layerAt, type LayerNodes, type LayerRange } from './layer'
import { footprintOf, subpointOffset, type CloudSample } from './sample'
import { sampleLayer, sampleLayerAt, type SampleOptions } from './sampleLayer'
import { ifStorm } from './storm'
import { keepStorm, keptStorm, type KeptStorm } from './stormNearby'
import { footOf, stormsAt } from './weather'
import { unpackBackground, weatherBackground, type PackedBackground } from './weatherBackground'

// The only answer to where the clouds are. `sampleLayerAt` (sampleLayer.ts) goes from a place and the weather's
// background to extinction and strength; pixels, shadows and light differ in which layers they ask, and in
// where they have the background from.

/** Options of the light march: no detail, and the inside of clouds, where its light is. */
const LIT: SampleOptions = { detail: false, unresolved: 'inside' }

/** Background of the weather at a sample: from a map, or looked up at the place itself. */
export function backgroundAt(
  field: CloudField,
  layer: LayerNodes,
  sample: CloudSample,
  mapped?: { map: WeatherMap | undefined; index: Int }
): PackedBackground {
  // As under a closed sky: it rules no clouds out.
  if (field.extinction) return vec4(1)
  const subpoint = subpointOffset(field, sample).toConst() as Vec3
  const footprint = footprintOf(field, sample)
  const { map, index } = mapped ?? {}
  return map === undefined || index === undefined
    ? weatherBackground(field, layer, subpoint, sample, footprint)
    : map.sample(layer, index, subpoint, sample.up, footprint)
}

/** The weather around a place, kept for places nearby: that of the layer which is densest there. */
export interface WeatherCache {
  readonly background: PackedBackground
  /** The layer's index. */
  readonly layer: Int
  /** The nearest storms, if it is a layer of storms; undefined where there are none. */
  readonly storm: KeptStorm | undefined
}

/** The storms nearest to a sample of a layer of storms: all samples of its light share one search. */
function keepStormsAt(
  field: CloudField,
  layer: LayerNodes,
  background: PackedBackground,
  sample: CloudSample,
  kept: KeptStorm
): void {
  const foot = footOf(field, layer, sample, heightIn(layer, sample.altitude))
  keepStorm(kept, stormsAt(field, layer, unpackBackground(background), foot))
}

const nothing = (): void => undefined

/** Weather around a place in the clouds. */
export function weatherCacheAt(
  field: CloudField,
  sample: CloudSample,
  range: LayerRange,
  map?: WeatherMap
): WeatherCache {
  const background = vec4(0).toVar() as Vec4
  const densest = int(0).toVar() as Int
  const most = float(-1).toVar()
  const isAlone = field.layers.length === 1
  const storm = hasStorms(field) === false ? undefined : keptStorm()
  forLayers(
    field,
    index => {
      const layer = layerAt(field, index)
      If(isWithin(layer, heightIn(layer, sample.altitude)), () => {
        const found = backgroundAt(field, layer, sample, { map, index })
        const own = isAlone || storm === undefined ? storm : keptStorm()
        if (own !== undefined) {
          ifStorm(layer, () => keepStormsAt(field, layer, found, sample, own), nothing)
        }
        if (isAlone) {
          background.assign(found)
          return
        }
        const extinction = float(0).toVar()
        // A layer that no other overlaps is the densest, whatever it has.
        If(range.last.sub(range.first).greaterThan(int(1)), () => {
          const options = { ...LIT, storm: own }
          extinction.assign(sampleLayer(field, layer, found, sample, options).extinction)
        })
        If(extinction.greaterThan(most), () => {
          most.assign(extinction)
          background.assign(found)
          densest.assign(index)
          if (storm !== undefined && own !== undefined) keepStorm(storm, own)
        })
      })
    },
    range
  )
  return { background, layer: densest, storm }
}

/**
 * Extinctions near a place whose weather was kept, of its densest layer, without detail [1/m]. Good as far as
 * the weather on large scales is the same. Unresolved clouds have that inside of them: what light meets
 * there is not their mean.
 *
 * @param samples - Places, as far from the camera as the first: their texture reads do not wait for each other.
 */
export function extinctionsNearby(
  field: CloudField,
  { background, layer: kept, storm }: WeatherCache,
  samples: readonly CloudSample[]
): Float[] {
  const layer = layerAt(field, field.layers.length === 1 ? int(0) : kept)
  const isInside = samples.map(({ altitude }): Bool => {
    const height = heightIn(layer, altitude)
    return height.greaterThan(0).and(height.lessThan(1)).toConst()
  })
  const extinctions = samples.map(() => float(0).toVar() as Float)
  If(
    isInside.reduce((any, each) => any.or(each)),
    () => {
      const options = { ...LIT, areApart: true, storm }
      const found = sampleLayerAt(field, layer, background, samples[0], samples, options)
      found.forEach(({ extinction }, i) => {
        extinctions[i].assign(select(isInside[i], extinction, 0))
      })
    }
  )
  return extinctions
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
  const background = backgroundAt(field, layer, middle)
  const found = sampleLayerAt(field, layer, background, middle, samples, { detail: false })
  const inside = samples.map(({ altitude }, i) =>
    select(isWithin(layer, heightIn(layer, altitude)), found[i].extinction, 0)
  )
  return vec2(...(inside as [Float, Float])).toConst()
}
