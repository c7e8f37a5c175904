import { Break, If, float, vec2, vec3, vec4 } from 'three/tsl'
import { forLayers, layerAt, type LayerRange } from '../../density/tsl/layer'
import type { CloudSample } from '../../density/tsl/sample'
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
import { GOLDEN_RATIO } from '../../march/FrameUniforms'
import { fallenFrom } from './fall'
import type { FallNodes } from './fallColumn'
import { fallExtinctions } from './fallExtinctions'
import type { FallStretch } from './fallStretch'

/** Most steps of a ray over the quality's `layerSteps`. Fewer: the far end of rain is coarse (*Rain and snow*). */
const STEPS = 2.5

/** Most steps of a ray where that makes fewer: rays are the wider apart then, so that they are cheap. Fewer: grain (`low`). */
const LEAST_STEPS = 32

/** `layerSteps` for which steps are as long as streaks ask for: with fewer they are longer, by at most `COARSEST`, with more shorter. */
const FINE_STEPS = 18
const COARSEST = 1.3
const FINEST = 0.25

/** Length of a step over its distance from the camera, at least [–]. Greater: grain in far shafts (*Rain and snow*). */
const GROWTH = 0.012

/**
 * Lengths of steps where nothing falls, over those in what falls, and the rank of columns from which on they begin to shorten. Longer: edges
 * of shafts have grain; shorter: rays take longer (*Rain and snow*).
 */
const LEAP = 4
const NEAR_RANK = -0.2

/**
 * Run of steps that share one look-up of light: it ends when so large a part of the picture's light comes from it, after so many steps, or
 * with the shaft. Greater: shadows in shafts have grain (*Rain and snow*).
 */
const RUN_SEEN = 0.2
const RUN_STEPS = 6

/** Share of a step's length up to which the weather is blurred [–]. Greater: streaks vanish far away; smaller: grain there. */
const BLUR = 0.04

/** Part of the picture's light below which what falls is not lit. */
export const LEAST_SEEN = 1e-4

/** Precipitation on a ray. Depths count without what is only diffracted. */
export interface SeenPrecipitation {
  /** Part of the picture's light that it scatters: what does not pass. All else is a mean, weighted by it. */
  readonly weight: Float
  /** Distance, and its standard deviation [m]. */
  readonly distance: Float
  readonly spread: Float
  /** Rank of the columns above, in [0, 1]. */
  readonly rank: Float
  /** Scaled optical depth of clouds towards the light. */
  readonly depthToLight: Float
  /** Optical depth of precipitation towards the light. */
  readonly ownDepth: Float
  /** Direct light that arrives unscattered, over that above the clouds, on drops and on flakes [–]. */
  readonly lit: Vec2
}

/** Space in which something falls. */
export interface FallSpace {
  readonly fallOf: (index: Int) => FallNodes
  /** Layers from which something falls, and perhaps others between. */
  readonly layers: LayerRange
  /** Altitude above which nothing falls [m]. */
  readonly ceiling: Float
  /** Path of horizontal light through precipitation [m]. */
  readonly width: Float
  /** Length of steps that streaks ask for [m]. */
  readonly shortest: Float
}

/**
 * Marches a ray through what falls from the clouds: in steps that follow the width of streaks where something falls, and in long ones elsewhere. To be
 * called inside of a shader function.
 */
export function marchPrecipitation(
  context: ShadingContext,
  { fallOf, layers, ceiling, width, shortest }: FallSpace,
  { direction, jitter }: Omit<CloudRay, 'end'>,
  { from, span }: FallStretch
): SeenPrecipitation {
  const { field, weatherMap, light, shadows, quality } = context
  const { view } = field
  const most = quality.layerSteps.mul(STEPS).ceil().max(LEAST_STEPS).toConst() as Float
  const finest = float(FINE_STEPS).div(quality.layerSteps).clamp(FINEST, COARSEST)
  const least = shortest.mul(finest).toConst() as Float
  const end = from.add(span).toConst() as Float
  const start = from.toVar() as Variable<Float>
  const transmittance = float(1).toVar() as Variable<Float>
  /** Length of the next step over that of a step in what falls, by the last one's rank. */
  const leap = float(1).toVar() as Variable<Float>
  /** Weight, and sums by it: distance, its square, logarithm of the depth to the light. */
  const sums = vec4(0).toVar() as Variable<Vec4>
  /** Sums of light on drops and on flakes, of the depth of precipitation to the light, and of ranks. */
  const lights = vec4(0).toVar() as Variable<Vec4>
  /** The present run: its weight, and sums by that of distances with noise, extinctions, and those of flakes; of ranks, and its steps. */
  const run = vec4(0).toVar() as Variable<Vec4>
  const others = vec2(0).toVar() as Variable<Vec2>
  const sampleAt = (at: Float, distance: Float): CloudSample => {
    const offset = direction.mul(at).toConst() as Vec3
    return { offset, ...view.localCoordinates(offset), distance }
  }
  /** Adds the light of the present run. */
  const addLight = (): void => {
    const seen = run.x.toConst() as Float
    const [at, extinction, flaked] = [run.y, run.z, run.w].map(
      sum => sum.div(seen).toConst() as Float
    )
    const sample = sampleAt(at, at)
    const toLight = lightAt(context, sample)
    const { toLight: depthToLight, inMap } = sampleShadows(shadows, sample.offset)
    const mapped = inMap.mul(toLight.isMapped).toConst() as Float
    const clouds = depthToLight.mul(mapped).mul(light.depthScale).toConst() as Float
    const slant = toLight.cosine.max(0.05).reciprocal()
    // The ray to the light leaves the shaft at its top, or at its side.
    const aside = width.div(toLight.cosine.mul(toLight.cosine).oneMinus().max(1e-4).sqrt())
    const own = ceiling.sub(sample.altitude).mul(slant).min(aside).mul(extinction)
    // The map has what falls, too.
    const lit = clouds.add(own.mul(mapped.oneMinus())).negate().exp().mul(seen).toConst() as Float
    const flakes = flaked.div(extinction).toConst() as Float
    const ofClouds = clouds.sub(own.mul(mapped)).max(0)
    sums.addAssign(vec4(0, 0, 0, ofClouds.add(1).log().mul(seen)))
    lights.addAssign(vec4(lit.mul(flakes.oneMinus()), lit.mul(flakes), own.mul(seen), others.x))
  }
  If(span.greaterThan(1), () => {
    loop('fallStep', most.toInt(), index => {
      const left = end.sub(start).toConst() as Float
      const part = float(index).add(1).div(most).toConst() as Float
      const square = part.mul(part).toConst() as Float
      // The last steps take all that is left.
      const even = left.mul(square).mul(square).mul(square)
      const length = least.max(start.mul(GROWTH)).max(even).mul(leap).min(left).toConst() as Float
      const at = start.add(length.mul(jitter)).toConst() as Float
      const sample = sampleAt(at, at.max(length.mul(BLUR).div(field.pixelAngle)).toConst())
      /** Extinction, the same of flakes and stones, and of ranks. */
      const found = vec3(0).toVar() as Variable<Vec3>
      const near = float(-1).toVar() as Variable<Float>
      // A place of the drops' speeds for each step, each as often.
      const speed = float(index).mul(GOLDEN_RATIO).add(jitter).fract().sub(0.5) as Float
      const visit = (layer: Int): void => {
        const falls = fallOf(layer)
        const fallen = fallenFrom(field, weatherMap, layerAt(field, layer), falls, sample, speed)
        near.assign(near.max(fallen.rank))
        If(fallen.rank.greaterThan(0), () => {
          const extinctions = fallExtinctions(fallen.rate, fallen.snow, fallen.hail).toConst()
          found.addAssign(vec3(extinctions, extinctions.x.mul(fallen.rank)))
        })
      }
      forLayers(field, visit, layers)
      If(found.x.greaterThan(0), () => {
        const extinction = found.x.mul(1 - DIFFRACTED).toConst() as Float
        const through = extinction.mul(length).negate().exp().toConst() as Float
        const seen = transmittance.mul(through.oneMinus()).toConst() as Float
        const flaked = found.y.mul(1 - DIFFRACTED)
        const middle = start.add(length.div(2)).toConst() as Float
        const distances = vec2(middle, middle.mul(middle).add(length.mul(length).div(12)))
        sums.addAssign(vec4(1, distances, 0).mul(seen))
        run.addAssign(vec4(1, at, extinction, flaked).mul(seen))
        others.addAssign(vec2(found.z.div(found.x).mul(seen), 1))
        transmittance.mulAssign(through)
      })
      start.addAssign(length)
      const far = float(NEAR_RANK)
        .sub(near)
        .div(1 + NEAR_RANK)
        .clamp()
      leap.assign(far.mul(LEAP - 1).add(1))
      const isDone = transmittance.lessThan(LEAST_TRANSMITTANCE).or(start.add(1).greaterThan(end))
      const isEnd = isDone
        .or(run.x.greaterThan(RUN_SEEN))
        .or(others.y.greaterThan(RUN_STEPS - 0.5))
        .or(near.lessThanEqual(0))
      If(run.x.greaterThan(LEAST_SEEN).and(isEnd), () => {
        addLight()
        run.assign(vec4(0))
        others.assign(vec2(0))
      })
      If(isDone, () => {
        Break()
      })
    })
  })
  const weight = sums.x.max(1e-6).toConst() as Float
  const distance = sums.y.div(weight).toConst() as Float
  return {
    weight: sums.x,
    distance,
    spread: sums.z.div(weight).sub(distance.mul(distance)).max(0).sqrt().toConst(),
    rank: lights.w.div(weight).toConst(),
    depthToLight: sums.w.div(weight).exp().sub(1).max(0).toConst(),
    ownDepth: lights.z.div(weight).toConst(),
    lit: vec2(lights.x, lights.y).toConst()
  }
}
