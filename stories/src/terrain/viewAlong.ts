import { MathUtils } from 'three'

/** A view from above the ground of a planet. */
export interface GroundView {
  readonly label: string
  readonly longitude: number
  readonly latitude: number
  /** Height above the ground [m]. */
  readonly height: number
  readonly heading: number
  readonly pitch: number
}

/** Height to which a way between two views rises, over its length: so high does one see both ends. */
const RISE = 0.12

/** Length of a degree of latitude [m]. */
const DEGREE = 111_000

/**
 * View on a way through several, without a cut: heights over the ground go by their ratio, as what one sees does.
 *
 * @param part - Part of the way, in [0, 1].
 */
export function viewAlong(views: readonly GroundView[], part: number): GroundView {
  const along = MathUtils.clamp(part, 0, 1) * (views.length - 1)
  const index = Math.min(Math.floor(along), views.length - 2)
  const [from, to] = [views[index], views[index + 1]]
  const share = MathUtils.smootherstep(along - index, 0, 1)
  const mix = (a: number, b: number): number => MathUtils.lerp(a, b, share)
  const turn = ((((to.heading - from.heading) % 360) + 540) % 360) - 180
  const across = (to.longitude - from.longitude) * Math.cos(MathUtils.degToRad(to.latitude))
  const length = DEGREE * Math.hypot(across, to.latitude - from.latitude)
  const rise = RISE * length * Math.sin(Math.PI * share)
  return {
    label: to.label,
    longitude: mix(from.longitude, to.longitude),
    latitude: mix(from.latitude, to.latitude),
    height: Math.exp(mix(Math.log(from.height), Math.log(to.height))) + rise,
    heading: from.heading + turn * share,
    pitch: mix(from.pitch, to.pitch)
  }
}
