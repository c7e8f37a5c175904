import type { Picture } from './picture'

/** Colours of a picture as they are shown, in [0, 1], without alpha. */
const shown = ({ data }: Picture): number[] =>
  Array.from(
    data.filter((_, i) => i % 4 !== 3),
    value => Math.min(Math.max(value, 0), 1) ** (1 / 2.2)
  )

/** Factor of a change that fits a fault best, by least squares. */
function share(fault: readonly number[], change: readonly number[]): number {
  const along = fault.reduce((sum, value, i) => sum + value * change[i], 0)
  return along / change.reduce((sum, value) => sum + value * value, 0)
}

/**
 * Trail of a turning picture: the share of an earlier picture that is left in it, less that of one that is yet to come, for blur
 * has no direction. 0 without trails, 1 where nothing but the earlier picture is shown and that is unlike both others.
 *
 * @param drawn - The picture in turning.
 * @param exact - As it should be.
 * @param earlier - As it should have been some frames before.
 * @param later - As it should be as many frames on.
 */
export function trailOf(drawn: Picture, exact: Picture, earlier: Picture, later: Picture): number {
  const [seen, now, before, after] = [drawn, exact, earlier, later].map(shown)
  const less = (values: readonly number[]): number[] => values.map((value, i) => value - now[i])
  const fault = less(seen)
  return share(fault, less(before)) - share(fault, less(after))
}
