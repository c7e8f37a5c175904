import { Break, If, float, int, vec4 } from 'three/tsl'
import { select } from '../../select'
import {
  loop,
  type Bool,
  type Float,
  type Int,
  type Variable,
  type Vec2,
  type Vec3
} from '../../tsl-types'
import { hasStorms, knowsStorms } from '../../density/kinds'
import { samplePair, type ClearLayers } from '../../density/tsl/samplePair'
import type { CloudSample } from '../../density/tsl/sample'
import { LEAST_TRANSMITTANCE } from '../../light/tsl/lighting'
import type { ShadingContext } from '../../light/tsl/shadingContext'
import { FAR_AWAY, layersAt, nextLayerBoundary } from './layerBoundaries'
import { FARTHEST_KNOWN, type ClearAir } from './clearAir'
import { addPair, seenClouds, seenState, endStratum, type SeenClouds } from './seenPoints'
import { cloudySteps, forgetClear, keepLastClear, lastClear } from './edges'
import { advance, enterSteps, nextSteps, stepState } from './steps'

/**
 * Number of layers from which a ray has a loop in a loop: rays side by side then wait for each other at each boundary, and
 * so run the code of the same layer. Fewer: slower with one layer, and software renderers take long to compile it;
 * more: skies of several layers take half as long again. Environment maps, drawn now and then, never have it.
 */
const NESTED_FROM = 3

/** Most crossings of a ray with the boundaries of a layer: two with each, on the way down and up again. */
const CROSSINGS = 4

/**
 * Growth of steps with the distance in skies with storms, over that in others [–]: towers are large and dense. Greater: faster, and
 * contours in towers (*Storm*).
 */
const STORM_GROWTH = 1.6

/** A ray from the camera, in the mapped space. */
export interface CloudRay {
  /** Unit length. */
  direction: Vec3
  /** Distance where it ends, at the ground at the latest [m]. */
  end: Float
  /** Noise that shifts the steps of the ray, in [0, 1). */
  jitter: Float
  /** Its clear air, and the distance up to which this may be out of date [m]. Left out, it is marched whole. */
  clear?: ClearAir & { unsureUntil: Float }
}

/** Clouds on a ray. */
export interface MarchedClouds extends SeenClouds {
  /** Steps that were taken. */
  steps: Float
  /** Distance of the first cloud; 0 if there is none [m]. */
  first: Float
}

/** The stretch of a ray between two layer boundaries; before the first it has ended. */
const segmentState = () => ({
  /** Distance where it ends [m]. */
  end: float(0).toVar(),
  /** The layers that are there. */
  range: { first: int(0).toVar() as Int, last: int(0).toVar() as Int }
})

/**
 * Marches a ray through all layers, from boundary to boundary: jumps where no layer is, goes by likely
 * distances through clear air, and ends where nothing more is seen. Steps go in pairs.
 *
 * To be called inside of a shader function.
 */
export function marchClouds(
  { field, weatherMap, light, quality }: Omit<ShadingContext, 'shadows'>,
  { direction, end, jitter, clear: known }: CloudRay
): MarchedClouds {
  const { view } = field
  const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
  const sampleAt = (distance: Float): CloudSample => {
    const at = distance.toConst() as Float
    const offset = direction.mul(at).toConst() as Vec3
    return { offset, ...view.localCoordinates(offset), distance: at }
  }
  const seen = seenState()
  // Environment maps, drawn now and then, step alike through skies of any kind.
  const isCamera = known !== undefined
  const state = stepState(jitter, !isCamera || hasStorms(field) !== false)
  const growth = isCamera && knowsStorms(field) ? STORM_GROWTH : 1
  const stepGrowth = quality.stepGrowth.mul(growth) as Float
  const segment = segmentState()
  const clear = vec4(0).toVar() as ClearLayers
  /** Pairs of samples so far, of all segments. */
  const pairs = int(0).toVar() as Variable<Int>
  const position = float(0).toVar()
  const last = lastClear()
  /** Distance of the first layer; 0 before. */
  const entry = float(0).toVar()
  /** Distance of the first cloud; 0 before. */
  const first = float(0).toVar()

  const { length } = field.layers
  const isNested = isCamera && length >= NESTED_FROM
  const isDone = (until: Float): Bool => {
    const isSeen = seen.transmittance.lessThan(LEAST_TRANSMITTANCE)
    const isOver = position.greaterThanEqual(until).or(isSeen)
    // One loop alone counts them itself.
    return isNested ? isOver.or(pairs.greaterThanEqual(quality.pairs)) : isOver
  }
  const enterSegment = (): void => {
    endStratum(seen)
    const boundary = nextLayerBoundary(field, cosView, position.mul(1 + 1e-6).add(0.01))
      .min(end)
      .toConst() as Float
    const { altitude } = view.localCoordinates(direction.mul(position.add(boundary).mul(0.5)))
    const { base, top, density, range } = layersAt(field, altitude)
    segment.end.assign(boundary)
    segment.range.first.assign(range.first)
    segment.range.last.assign(range.last)
    enterSteps(state, field, quality, density.mul(light.depthScale), position, boundary)
    If(base.greaterThan(top), () => {
      position.assign(boundary)
      forgetClear(last)
    }).ElseIf(entry.equal(0), () => {
      entry.assign(position.max(1))
    })
  }
  const goOn = (): void => {
    pairs.addAssign(1)
    const pair = nextSteps(state, stepGrowth, position, segment.end, seen.transmittance)
    const { length } = pair
    const places = [0.5, 1.5].map(at => position.add(length.mul(at)).toConst() as Float)
    const middle = sampleAt(position.add(length))
    const { range } = segment
    const clouds = samplePair(field, weatherMap, clear, middle, length, direction, range)
    const found = {
      ...clouds,
      extinction: clouds.extinction.mul(light.depthScale).toConst() as Vec2,
      greatest: clouds.greatest.mul(light.depthScale)
    }
    const accept = (): void => {
      first.assign(select(first.equal(0), position.max(1), first))
      const { lengths, middles } = cloudySteps(last, places, clouds.strength, length)
      addPair(seen, found.extinction.mul(lengths).toConst(), middles, lengths)
    }
    const forward = advance(state, pair, quality, found, accept)
    keepLastClear(last, places, clouds.strength, forward.lessThan(length.mul(2)).toConst())
    position.addAssign(forward)
  }

  const skipClear = (): void => {
    if (known === undefined) return
    const { until, from, unsureUntil } = known
    const isInLayer = entry.greaterThan(0).and(entry.lessThan(FARTHEST_KNOWN))
    If(
      isInLayer
        .and(position.greaterThanEqual(unsureUntil))
        .and(first.equal(0))
        .and(state.isFine.not()),
      () => {
        If(position.lessThan(until), () => {
          position.assign(until)
          forgetClear(last)
          state.likely.assign(0)
        }).ElseIf(position.greaterThan(from), () => {
          position.assign(FAR_AWAY)
        })
      }
    )
  }

  loop('cloudSegment', isNested ? CROSSINGS * length + 1 : quality.pairs, () => {
    If(isDone(end), () => {
      Break()
    })
    if (isNested) {
      enterSegment()
      loop('cloudPair', quality.pairs, () => {
        If(isDone(segment.end), () => {
          Break()
        })
        skipClear()
        If(position.lessThan(segment.end), goOn)
      })
    } else {
      If(position.greaterThanEqual(segment.end), enterSegment).Else(() => {
        skipClear()
        If(position.lessThan(segment.end), goOn)
      })
    }
  })
  const nothing = select(entry.greaterThan(0), entry, end.min(FAR_AWAY)) as Float
  return { ...seenClouds(seen, nothing), steps: float(pairs).mul(2), first }
}
