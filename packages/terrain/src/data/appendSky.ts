import type { PageRequest } from '../pages/PageSource'
import { DISTANCES, FARTHER, FINENESS, NEAREST, skyShare } from '../pages/cpu/skyShare'

/** Farthest place that hides sky [m]. */
const FARTHEST = NEAREST * FARTHER ** (DISTANCES - 1)

/** Width of the cells between which shares of the sky are interpolated [m], and most of them along an edge of a page. */
const CELL = 64
const MOST_CELLS = 6

/** Half of the distance over which a slope is taken [m]. */
const SLOPE_REACH = NEAREST / 2

/** Height of a place so far east and north of another, without what is shorter than `detail` [m]. */
export type HeightAbout = (east: number, north: number, detail: number) => number

/**
 * Heights of a page, with the shares of the sky that the ground about its vertices leaves free: found at some of its places, linear between.
 *
 * @param heights - As many as asked for.
 * @param about - Heights about a place of the page, by its number.
 * @returns Same heights where no ground is steep enough to count: pages of continents.
 */
export function appendSky(
  heights: Float32Array,
  { side, spacing, vertices }: PageRequest,
  about: (place: number) => HeightAbout
): Float32Array {
  const steps = side - 3
  const shortest = (2 * spacing * steps) / (vertices - 1)
  if (shortest > FARTHEST) return heights
  const wanted = Math.ceil((spacing * steps) / CELL)
  const cells = Math.min(2 ** Math.ceil(Math.log2(wanted)), MOST_CELLS, steps)
  const shares: number[] = []
  for (let row = 0; row <= cells; row++) {
    for (let column = 0; column <= cells; column++) {
      const at = (n: number): number => 1 + Math.round((n * steps) / cells)
      const heightAbout = about(at(row) * side + at(column))
      const heightAt = (east: number, north: number): number =>
        heightAbout(
          east,
          north,
          Math.max(shortest, FINENESS * Math.hypot(east, north), FINENESS * NEAREST)
        )
      const slope = (x: number, y: number): number =>
        (heightAt(x, y) - heightAt(-x, -y)) / (2 * SLOPE_REACH)
      shares.push(skyShare(heightAt, slope(SLOPE_REACH, 0), slope(0, SLOPE_REACH)))
    }
  }
  const all = new Float32Array(heights.length + vertices ** 2)
  all.set(heights)
  const ends = vertices - 1
  for (let n = 0; n < vertices ** 2; n++) {
    const [x, y] = [((n % vertices) * cells) / ends, (Math.floor(n / vertices) * cells) / ends]
    const [i, j] = [Math.min(Math.floor(x), cells - 1), Math.min(Math.floor(y), cells - 1)]
    const at = j * (cells + 1) + i
    const [a, b] = [at, at + cells + 1].map(
      first => shares[first] + (x - i) * (shares[first + 1] - shares[first])
    )
    all[heights.length + n] = a + (y - j) * (b - a)
  }
  return all
}
