import { Break, If, bool, float, int, vec3 } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../../density/CloudField'
import type { LayerNodes } from '../../density/tsl/layer'
import { sampleLayerPair } from '../../density/tsl/sampler'
import type { CloudSample } from '../../density/tsl/sample'
import { loop, type Bool, type Float, type Int, type Vec3 } from '../../tsl-types'
import type { LayerSegment } from './layerSegment'

/** Clouds that a ray of light meets on a stretch. */
export interface StretchMoments {
  /** Optical depth, the same times place and times its square, not scaled. */
  readonly sums: Vec3
  /** Distance at which clouds begin on the side of the light; `NO_CLOUDS` if there are none [m]. */
  readonly entry: Float
}

/** Distance of the first cloud where there are none [m]. */
export const NO_CLOUDS = -1e9

/** Samples of a ray through a layer. Fewer: bands in the shadows of thin clouds under a low sun (*Shadows*). */
export const STEPS = 48

/**
 * Steps longer than this are cut in three to find where clouds begin [m]; how often, and on a ray. Without,
 * shadows on tall clouds have rings as wide as steps (*Storm*).
 */
const SEARCH_FROM = 100
const CUTS = 2
const SEARCHES = 2

/** The search for the edge of a cloud between a clear place and one in it. */
interface EdgeSearch {
  /** Distance of the last point that is clear, and of the first in the cloud [m]. */
  readonly clear: Float & Assignable<Float>
  readonly cloudy: Float & Assignable<Float>
  /** Cuts that this search still makes, and searches that the ray may still make. */
  readonly cuts: Int & Assignable<Int>
  readonly searches: Int & Assignable<Int>
}

interface Assignable<T> {
  assign(value: T): void
  subAssign(value: T): void
}

/**
 * Optical depth of a layer on a segment, its moments, and where it begins: a march from the
 * side of the light, in pairs of samples that share weather.
 *
 * @param length - Length of a step [m].
 * @param sampleAt - The ray's sample at a distance.
 */
export function segmentMoments(
  field: CloudField,
  layer: LayerNodes,
  { front, back }: LayerSegment,
  length: Float,
  sampleAt: (distance: Float) => CloudSample
): StretchMoments {
  const sums = vec3(0).toVar() as Vec3
  const entry = float(NO_CLOUDS).toVar()
  const add = (top: Float, extinction: Float): void => {
    const width = top.sub(back).clamp(0, length).toConst() as Float
    const middle = top.sub(width.mul(0.5)).toConst() as Float
    const square = middle.mul(middle).add(width.mul(width).div(12))
    sums.addAssign(vec3(1, middle, square).mul(extinction.mul(width)))
    entry.assign(select(extinction.greaterThan(0), entry.max(top), entry))
  }
  const position = front.toVar() as Float
  const search = edgeSearch(front, length)
  const wasClear = bool(true).toVar() as Bool
  loop('shadowPair', STEPS / 2 + SEARCHES * (CUTS + 2), () => {
    If(position.lessThanEqual(back), () => {
      Break()
    })
    const isCutting = search.cuts.greaterThan(0).toConst()
    const gap = search.clear.sub(search.cloudy)
    const step = select(isCutting, gap.div(3), length).toConst() as Float
    const from = select(isCutting, search.clear.sub(step.mul(0.5)), position).toConst() as Float
    const [middle, first, second] = [1, 0.5, 1.5].map(steps => sampleAt(from.sub(step.mul(steps))))
    const found = sampleLayerPair(field, layer, middle, [first, second])
    /** First of the two in clouds, in steps; 2.5 if both are clear. */
    const cloudy = select(found.x.greaterThan(0), 0.5, select(found.y.greaterThan(0), 1.5, 2.5))
    const at = from.sub(step.mul(cloudy)).toConst() as Float
    If(isCutting, () => {
      narrow(search, at, step)
      search.cuts.subAssign(int(1))
      position.assign(at.add(step.mul(0.5)))
    })
      .ElseIf(wasClear.and(cloudy.lessThan(2)).and(search.searches.greaterThan(0)), () => {
        narrow(search, at, step)
        search.cuts.assign(int(CUTS))
        search.searches.subAssign(int(1))
        wasClear.assign(false)
      })
      .Else(() => {
        add(position, found.x)
        add(position.sub(length), found.y)
        wasClear.assign(found.y.equal(0))
        position.subAssign(length.mul(2))
      })
  })
  return { sums, entry }
}

/** No search yet: short steps need none. */
const edgeSearch = (front: Float, length: Float): EdgeSearch => ({
  clear: front.toVar(),
  cloudy: front.toVar(),
  cuts: int(0).toVar(),
  searches: int(select(length.greaterThan(SEARCH_FROM), SEARCHES, 0)).toVar()
})

/** Puts the edge between a place in the cloud and a step before it. */
function narrow({ clear, cloudy }: EdgeSearch, at: Float, step: Float): void {
  cloudy.assign(at)
  clear.assign(at.add(step))
}
