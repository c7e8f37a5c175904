import type { Picture } from './picture'

/** Value of a colour as it is shown, in [0, 1]. */
const shown = (value: number): number => Math.min(Math.max(value, 0), 1) ** (1 / 2.2)

/** Factor of a picture's change to another that fits a fault best, by least squares. */
function share(fault: readonly number[], from: readonly number[], to: Picture): number {
  let [along, all] = [0, 0]
  for (const [i, value] of from.entries()) {
    const change = shown(to.data[i]) - value
    along += fault[i] * change
    all += change * change
  }
  return along / all
}

/**
 * Trail of a turning picture: the share of an earlier picture that is left in it, less that of one that is yet to come, for blur
 * has no direction. 0 without trails, 1 where nothing but the earlier picture is shown.
 *
 * @param drawn - The picture in turning.
 * @param exact - As it should be.
 * @param earlier - As it should have been some frames before.
 * @param later - As it should be as many frames on.
 */
export function trailOf(drawn: Picture, exact: Picture, earlier: Picture, later: Picture): number {
  const isColor = (_: unknown, i: number): boolean => i % 4 !== 3
  const from = [...exact.data].map((value, i) => (isColor(value, i) ? shown(value) : 0))
  const fault = from.map((value, i) => (isColor(value, i) ? shown(drawn.data[i]) - value : 0))
  return (share(fault, from, earlier) - share(fault, from, later)) / 2
}
