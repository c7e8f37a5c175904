import { Break, If, float, vec2, vec3, vec4 } from 'three/tsl'
import { forLayers, layerAt, type LayerRange } from '../../density/tsl/layer'
import type { CloudSample } from '../../density/tsl/sample'
import type { SeenPoints } from '../../march/tsl/seenPoints'
import type { CloudRay } from '../../march/tsl/march'
import { sampleShadows } from '../../shadow/tsl/sampleShadows'
import { LEAST_TRANSMITTANCE, lightAt } from '../../light/tsl/lighting'
import type { ShadingContext } from '../../light/tsl/shadingContext'
import {
  loop,
  type Float,
  type Int,
  type Variable,
  type Vec2,
  type Vec3,
  type Vec4
} from '../../tsl-types'
import { DIFFRACTED } from '../fallForm'
import { fallenFrom, fallExtinctions } from './fall'
import type { FallNodes } from './fallColumn'
import { distanceAt, type FallStretch } from './fallStretch'

/**
 * Groups of steps of a ray over the quality's `layerSteps`, and steps of a group. Light is found once for a group, where most of it is
 * seen. Fewer: grain in far shafts (*Rain and snow*).
 */
const GROUPS = 0.2
const GROUP = 3

/** Fewest groups: rays to the ground nearby and up to the clouds are short. */
const LEAST = 2

/** Share of a step's length up to which the weather is blurred [–]. Greater: streaks vanish far away; smaller: grain there. */
const BLUR = 0.04

/** Part of the picture's light below which what falls is not lit. */
export const LEAST_SEEN = 1e-4

/** Precipitation on a ray. Depths count without what is only diffracted. */
export interface SeenPrecipitation {
  /** Share of light that passes all of it, and that from each point of the clouds; in [0, 1]. */
  readonly transmittance: Float
  readonly before: Vec4
  /** Part of the picture's light that it scatters, and its means by that part: */
  readonly weight: Float
  /** distance [m], */
  readonly distance: Float
  /** rank of the columns above, in [0, 1], */
  readonly rank: Float
  /** scaled depth of clouds towards the light, */
  readonly depthToLight: Float
  /** depth of precipitation towards the light, */
  readonly ownDepth: Float
  /** and direct light that arrives unscattered, over that above the clouds, of drops and of flakes. */
  readonly lit: Vec2
}

/** Space in which something falls. */
export interface FallSpace {
  readonly fallOf: (index: Int) => FallNodes
  /** Layers from which something falls, and perhaps others between. */
  readonly layers: LayerRange
  /** Altitude above which nothing falls [m]. */
  readonly ceiling: Float
  /** Way of level light through what falls [m]. */
  readonly width: Float
  /** Shortest mean length of steps [m]. */
  readonly shortest: Float
}

/**
 * Marches a ray through what falls from the clouds, in even steps from afar and growing ones from within, which go in groups. To be
 * called inside of a shader function.
 *
 * @param points - Clouds on the ray.
 */
export function marchPrecipitation(
  context: ShadingContext,
  { fallOf, layers, ceiling, width, shortest }: FallSpace,
  { direction, jitter }: Omit<CloudRay, 'end'>,
  stretch: FallStretch,
  points: SeenPoints
): SeenPrecipitation {
  const { field, weatherMap, light, shadows, quality } = context
  const { view } = field
  const { span } = stretch
  const groups = span
    .div(shortest.mul(GROUP))
    .clamp(LEAST, quality.layerSteps.mul(GROUPS))
    .ceil()
    .toConst() as Float
  const count = groups.mul(GROUP).toConst() as Float
  const transmittance = float(1).toVar() as Variable<Float>
  const before = vec4(1).toVar() as Variable<Vec4>
  /** Weight, and sums by it: distance, rank, logarithm of the depth to the light. */
  const sums = vec4(0).toVar() as Variable<Vec4>
  /** Sums of light on drops and on flakes, and of the depth of precipitation to the light. */
  const lights = vec4(0).toVar() as Variable<Vec4>
  const sampleAt = (at: Float, distance: Float): CloudSample => {
    const offset = direction.mul(at).toConst() as Vec3
    return { offset, ...view.localCoordinates(offset), distance }
  }
  /**
   * Adds what is seen of a group with its light.
   *
   * @param group - Its part, and sums by that of distances with noise, extinctions, and those of flakes.
   * @param others - Sums of the middles of steps, and of ranks.
   */
  const addLight = (group: Vec4, others: Vec2): void => {
    const seen = group.x.toConst() as Float
    const [at, extinction, flaked] = [group.y, group.z, group.w].map(
      sum => sum.div(seen).toConst() as Float
    )
    const sample = sampleAt(at, at)
    const toLight = lightAt(context, sample)
    const { toLight: depthToLight, inMap } = sampleShadows(shadows, sample.offset)
    const mapped = inMap.mul(toLight.isMapped).toConst() as Float
    const clouds = depthToLight.mul(mapped).mul(light.depthScale).toConst() as Float
    const slant = toLight.cosine.max(0.05).reciprocal()
    // Out of the shaft's top, or of its side.
    const aside = width.div(toLight.cosine.mul(toLight.cosine).oneMinus().max(1e-4).sqrt())
    const own = ceiling.sub(sample.altitude).mul(slant).min(aside).mul(extinction)
    // The map has what falls, too.
    const lit = clouds.add(own.mul(mapped.oneMinus())).negate().exp().mul(seen).toConst() as Float
    const flakes = flaked.div(extinction).toConst() as Float
    const ofClouds = clouds.sub(own.mul(mapped)).max(0)
    sums.addAssign(vec4(seen, others, ofClouds.add(1).log().mul(seen)))
    lights.addAssign(vec4(lit.mul(flakes.oneMinus()), lit.mul(flakes), own.mul(seen), 0))
  }
  If(span.greaterThan(1), () => {
    loop('fallGroup', groups.toInt(), index => {
      If(transmittance.lessThan(LEAST_TRANSMITTANCE), () => {
        Break()
      })
      const group = vec4(0).toVar() as Variable<Vec4>
      const others = vec2(0).toVar() as Variable<Vec2>
      loop('fallStep', GROUP, step => {
        const from = float(index).mul(GROUP).add(float(step)).toConst() as Float
        const [start, next] = [from, from.add(1)].map(
          place => distanceAt(stretch, place.div(count).toConst() as Float).toConst() as Float
        )
        const length = next.sub(start).toConst() as Float
        const at = start.add(length.mul(jitter)).toConst() as Float
        const sample = sampleAt(at, at.max(length.mul(BLUR).div(field.pixelAngle)).toConst())
        /** Extinction, the same of flakes and stones, and of ranks. */
        const found = vec3(0).toVar() as Variable<Vec3>
        const visit = (layer: Int): void => {
          const fallen = fallenFrom(field, weatherMap, layerAt(field, layer), fallOf(layer), sample)
          const extinctions = fallExtinctions(fallen.rate, fallen.snow, fallen.hail).toConst()
          found.addAssign(vec3(extinctions, extinctions.x.mul(fallen.rank)))
        }
        forLayers(field, visit, layers)
        If(found.x.greaterThan(0), () => {
          const extinction = found.x.mul(1 - DIFFRACTED).toConst() as Float
          const through = extinction.mul(length).negate().exp().toConst() as Float
          // Clouds in front hide it.
          const isBefore = vec4(at)
            .sub(points.distances)
            .div(points.distances.mul(0.1).max(50))
            .add(0.5)
            .clamp(0, 1)
          const unhidden = points.shares.dot(isBefore).oneMinus().max(0)
          const seen = transmittance.mul(unhidden).mul(through.oneMinus()).toConst() as Float
          const flaked = found.y.mul(1 - DIFFRACTED)
          group.addAssign(vec4(1, at, extinction, flaked).mul(seen))
          others.addAssign(vec2(start.add(next).div(2), found.z.div(found.x)).mul(seen))
          const ahead = points.distances.sub(start).clamp(0, length)
          before.mulAssign(ahead.mul(extinction).negate().exp())
          transmittance.mulAssign(through)
        })
      })
      If(group.x.greaterThan(LEAST_SEEN), () => {
        addLight(group, others)
      })
    })
  })
  const weight = sums.x.max(1e-6).toConst() as Float
  return {
    transmittance,
    before,
    weight: sums.x,
    distance: sums.y.div(weight).toConst(),
    rank: sums.z.div(weight).toConst(),
    depthToLight: sums.w.div(weight).exp().sub(1).max(0).toConst(),
    ownDepth: lights.z.div(weight).toConst(),
    lit: vec2(lights.x, lights.y).toConst()
  }
}
