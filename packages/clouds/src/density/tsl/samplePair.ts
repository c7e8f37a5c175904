import { If, bool, float, mix, vec2, vec4 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import type { WeatherMap } from '../WeatherMap'
import type { Bool, Float, Int, Variable, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { componentAt } from './componentAt'
import { denseShare } from './density'
import { densityAtHeight } from './heightForm'
import { forLayersUnrolled, heightIn, isWithin, layerAt, type LayerRange } from './layer'
import {
  CAUTION,
  clearOfStorms,
  likelyDistance,
  likelyDistanceByBackground,
  nearStorms,
  NOWHERE
} from './likelyDistance'
import { footprintOf, type CloudSample } from './sample'
import { sampleLayerAt } from './sampleLayer'
import { backgroundAt } from './sampler'
import { ifStorm, isStorm } from './storm'
import { keptStorm } from './stormNearby'

/** Strength of what was not sampled, less than any other [–]. */
export const NOT_SAMPLED = -1e4

/** Two samples of all clouds near each other. */
export interface SamplePair {
  /** At the first and at the second place [1/m]. */
  readonly extinction: Vec2
  /** Greatest `surface` of a layer at both, as of `LayerSample`; `NOT_SAMPLED` where that is not known [–]. */
  readonly strength: Vec2
  /** Distance from either in which there is likely no cloud; 0 in clouds [m]. */
  readonly likelyDistance: Float
  /** True where storms are so near that they were sampled. */
  readonly isNear: Bool
  /** Extinction that steps go by: what was found, and what is likely at their height [1/m]. */
  readonly greatest: Float
}

/**
 * Way down for which a background's likely distance holds at most, over the layer's thickness. Greater: rays from above jump over small
 * clouds where there is more than one layer, as dots (*Storm*).
 */
const FALL = 0.1

/** Distances up to which each layer is likely clear [m]: until there it is not sampled with the other layers. */
export type ClearLayers = Variable<Vec4>

/** A sample near another, on a straight line through it [m]: for its level of detail it is as far away. */
const sampleNearby = (sample: CloudSample, direction: Vec3, along: Float): CloudSample => ({
  ...sample,
  offset: sample.offset.add(direction.mul(along)).toConst(),
  altitude: sample.altitude.add(direction.dot(sample.up).mul(along)).toConst()
})

/**
 * Samples clouds at two places near each other on a ray, with detail.
 *
 * @param map - Weather around the camera; left out, it is looked up at the place itself.
 * @param clear - Clear layers, kept between samples of a ray.
 * @param middle - The place between both, within the altitudes of the same layers.
 * @param length - Distance between them [m].
 * @param direction - Direction of the ray, in the mapped space.
 * @param range - The layers that are sampled.
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
  const places = [-0.5, 0.5].map(at => sampleNearby(middle, direction, length.mul(at)))
  const sum = vec2(0).toVar() as Vec2
  const strength = vec2(NOT_SAMPLED).toVar() as Vec2
  const nearest = float(NOWHERE).toVar()
  const isNear = bool(false).toVar()
  const greatest = float(0).toVar()
  const end = middle.distance.add(length.mul(0.5)).toConst()
  const isAlone = field.layers.length === 1
  const look = (index: Int, known: number): void => {
    const layer = layerAt(field, index, known)
    const height = heightIn(layer, middle.altitude)
    const own = componentAt(float(index))
    const clearUntil = isAlone ? float(0) : clear.dot(own).toConst()
    const isHere = isWithin(layer, height).toConst()
    If(isHere.and(clearUntil.lessThan(end)), () => {
      const most = layer.density.mul(densityAtHeight(layer, height)).toConst() as Float
      // A user's own clouds have edges of their own.
      const dense = field.extinction ? most : most.mul(denseShare(layer, height))
      greatest.assign(greatest.max(dense))
      const background = backgroundAt(field, layer, middle, { map, index })
      const likely = float(0).toVar()
      const storm = keptStorm()
      ifStorm(
        layer,
        () => {
          likely.assign(clearOfStorms(field, layer, background, middle, length, storm))
        },
        () => {
          const footprint = footprintOf(field, middle)
          const found = likelyDistanceByBackground(layer, background, height, footprint)
          // Farther down, weaker columns are clouds.
          const rise = direction.dot(middle.up).min(-1e-3)
          likely.assign(found.min(layer.thickness.mul(-FALL).div(rise)))
        }
      )
      likely.mulAssign(field.skipping.floor())
      If(likely.lessThanEqual(0), () => {
        const [first, second] = sampleLayerAt(field, layer, background, middle, places, {
          detail: true,
          direction,
          storm
        })
        // A user's own clouds have none that tells how far their edges are.
        if (!field.extinction) {
          strength.assign(strength.max(vec2(first.surface, second.surface)))
        }
        const strongest = first.strength.max(second.strength)
        likely.assign(likelyDistance(layer, strongest).mul(field.skipping))
        sum.addAssign(vec2(first.extinction, second.extinction))
        greatest.assign(greatest.max(first.extinction).max(second.extinction))
        if (layer.hasStorms !== false) isNear.assign(isNear.or(isStorm(layer)))
      })
      if (!isAlone) {
        const until = end.add(likely.mul(CAUTION)).mul(likely.sign())
        clear.assign(mix(clear, vec4(until), own))
      }
      nearest.assign(nearest.min(likely))
    }).ElseIf(isHere, () => {
      const left = clearUntil.sub(end).toConst() as Float
      nearest.assign(nearest.min(left))
      if (layer.hasStorms !== false) {
        isNear.assign(isNear.or(isStorm(layer).and(left.lessThan(nearStorms(layer)))))
      }
    })
  }
  forLayersUnrolled(field, look, range)
  return { extinction: sum, strength, likelyDistance: nearest, isNear, greatest }
}
