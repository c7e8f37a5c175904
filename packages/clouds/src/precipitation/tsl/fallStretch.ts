import { mix } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../../density/CloudField'
import { crossings, FAR_AWAY } from '../../march/tsl/layerBoundaries'
import type { CloudRay } from '../../march/tsl/march'
import { encodeDistance } from '../../temporal/tsl/packing'
import type { Float, Vec4 } from '../../tsl-types'

/** Longest stretch of a ray that is marched [m]: the weather map ends there, and haze hides shafts. */
const LONGEST = 30_000

/** Distance from which on nothing is marched [m]: shafts lie under their clouds then. */
export const FARTHEST = 150_000

/** First steps over those of an even march [–], for rays that begin among shafts. */
const FIRST = 0.12

/**
 * Stretch of a ray on which something falls, the length of its first places' distances over those of even ones, and where the ray ends if that is
 * before what falls does; `FAR_AWAY` else [m].
 */
export interface FallStretch {
  readonly from: Float
  readonly span: Float
  readonly first: Float
  readonly end: Float
}

/** log₂ of where a marched ray ends: behind opaque clouds nothing is seen. @param distances - Distances of the clouds' points [m]. */
export const endOf = (marched: Vec4, { x, y, z, w }: Vec4): Float =>
  select(marched.z.greaterThan(0), marched.y, encodeDistance(x.max(y).max(z.max(w)))).toConst()

/**
 * Stretch of a ray that is marched; its span is 0 or less where nothing falls. To be called inside of a shader function.
 *
 * @param altitudes - Ceiling and floor: altitudes above and below which nothing falls [m].
 */
export function fallStretch(
  field: CloudField,
  { ceiling, floor }: { ceiling: Float; floor: Float },
  { direction, end }: Pick<CloudRay, 'direction' | 'end'>
): FallStretch {
  const { view } = field
  const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
  const shell = crossings(field, cosView, ceiling)
  const under = crossings(field, cosView, floor)
  const isBelow = view.height.lessThan(floor).toConst()
  const from = shell.near.max(select(isBelow, under.far, 0)).toConst() as Float
  const isLeaving = isBelow.not().and(under.near.greaterThan(0))
  const leaving = shell.far.min(select(isLeaving, under.near, FAR_AWAY))
  const last = leaving.min(from.add(LONGEST)).toConst() as Float
  const isNear = select(from.lessThan(FARTHEST), 1, 0)
  const span = last.min(end).sub(from).mul(isNear).toConst() as Float
  const first = mix(FIRST, 1, from.div(from.add(span.max(1)))).toConst() as Float
  return { from, span, first, end: select(end.lessThan(last), end, FAR_AWAY).toConst() }
}

/** Distance of a part of a stretch's steps, in [0, 1] [m]. */
export const distanceAt = <T extends Float | Vec4>(
  { from, span, first }: Omit<FallStretch, 'end'>,
  part: T
): T => part.mul(part.mul(first.oneMinus()).add(first)).mul(span).add(from) as T

/** The inverse of {@link distanceAt}. */
export function partAt({ from, span, first }: Omit<FallStretch, 'end'>, distance: Float): Float {
  const even = distance.sub(from).div(span.max(1)).clamp().toConst() as Float
  const root = first.mul(first).add(first.oneMinus().mul(even).mul(4)).sqrt()
  return even.mul(2).div(first.add(root))
}
