import { If, float, int, mix, vec4 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { loop, type Bool, type Float, type Int, type Vec4 } from '../../tsl-types'
import type { LayerNodes } from './layer'
import { footprintOf, subpointOffset, type CloudSample } from './sample'
import { weatherBackground, type PackedBackground } from './weatherBackground'

/**
 * Distance over which the weather's background along a ray is taken to change evenly [periods of the
 * weather]. Greater: clouds shift as one flies towards them (*Cockpit*).
 */
const SPAN = 0.05

/** Distance for far samples [footprints]. */
const FAR_SPAN = 16

/** The background of a layer's weather along a ray, looked up once in a while. */
export interface RayWeather {
  /** The layer that it is of; −1 for none. */
  readonly layer: Int & { assign: (n: Int | number) => void }
  /** Distances at which it was looked up [m], and what was found. */
  readonly from: FloatVariable
  readonly to: FloatVariable
  readonly first: Vec4 & { assign: (n: Vec4) => void }
  readonly last: Vec4 & { assign: (n: Vec4) => void }
  /** Distance up to which each layer is likely clear [m]. */
  readonly clear: Vec4 & { assign: (n: Vec4) => void }
}

/** A variable of a shader. */
type FloatVariable = Float & { assign: (n: Float | number) => void }

/** Nothing looked up yet. To be called inside of a shader function. */
export const rayWeather = (): RayWeather => ({
  layer: int(-1).toVar(),
  from: float(0).toVar(),
  to: float(0).toVar(),
  first: vec4(0).toVar(),
  last: vec4(0).toVar(),
  clear: vec4(0).toVar()
})

/**
 * Distance up to which a layer is likely clear: where layers overlap, the rarer ones are not looked at with
 * every sample of the others.
 */
export function clearLayer(
  { clear }: RayWeather,
  index: Int
): { until: Float; assign: (distance: Float) => void } {
  /** 1 in the layer's component, 0 in the others. */
  const own = vec4(0, 1, 2, 3).sub(float(index)).abs().min(1).oneMinus().toConst() as Vec4
  return {
    until: clear.dot(own).toConst(),
    assign: distance => {
      clear.assign(mix(clear, vec4(distance), own))
    }
  }
}

/**
 * Background of a layer's weather at a distance along a ray, between two places of which it was looked up.
 *
 * @param index - The layer's.
 * @param isAlone - False where layers overlap, which take turns: they are looked up at the distance itself.
 * @param sampleAt - The ray's sample at a distance.
 */
export function backgroundAlong(
  field: CloudField,
  { layer: known, from, to, first, last }: RayWeather,
  layer: LayerNodes,
  index: Int,
  isAlone: Bool,
  distance: Float,
  sampleAt: (distance: Float) => CloudSample
): PackedBackground {
  const isOther = known.notEqual(index).toConst()
  const isBehind = distance.lessThan(from).or(distance.greaterThan(to))
  If(isOther.or(isBehind), () => {
    const near = distance.mul(field.pixelAngle).mul(FAR_SPAN)
    const span = float(SPAN).div(layer.perWeatherPeriod).max(near).toConst() as Float
    const goesOn = isOther
      .not()
      .and(isAlone)
      .and(distance.greaterThanEqual(to))
      .and(distance.lessThan(to.add(span)))
      .toConst()
    first.assign(last)
    from.assign(to)
    // Its far end only where the near one is known: the code is there once.
    loop(
      'weatherEnd',
      isAlone.select(int(2), int(1)),
      end => {
        const at = end.equal(int(0)).select(distance, from.add(span)).toConst() as Float
        const sample = sampleAt(at)
        const subpoint = subpointOffset(field, sample).toConst()
        const found = weatherBackground(field, layer, subpoint, sample, footprintOf(field, sample))
        If(end.equal(int(0)), () => {
          first.assign(found)
          from.assign(at)
        }).Else(() => {
          last.assign(found)
          to.assign(at)
        })
      },
      goesOn.select(int(1), int(0))
    )
    If(isAlone.not(), () => {
      to.assign(from)
    })
    known.assign(index)
  })
  const part = distance.sub(from).div(to.sub(from).max(1e-3)).clamp(0, 1)
  return part.mix(first, last).toConst()
}
