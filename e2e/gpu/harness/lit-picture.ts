import { expectLight } from './atmosphere'
import { luminance } from './environment'
import { expectTrue } from './expect'
import type { Picture } from './picture'

/**
 * Least luminance of what ground, clouds or air fill, over the median of all that: snow is 20 times as bright as wet ground, and
 * things in the shade of clouds have a tenth of the light of those in the sun. What is drawn black has none.
 */
const LEAST = 1 / 200

/** Luminances in a picture of what must have light. */
export interface Lit {
  readonly median: number
  readonly least: number
}

/**
 * Fails if a number is not finite or negative, or if a pixel that must have light is black, or as good as black beside the others.
 *
 * @param mustBeLit - False for pixels of empty space.
 */
export function expectLit(
  picture: Picture,
  mustBeLit: (x: number, y: number) => boolean,
  label: string
): Lit {
  expectLight(picture, label)
  const { width, height } = picture
  const lit: { x: number; y: number; value: number }[] = []
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++)
      if (mustBeLit(x, y)) lit.push({ x, y, value: luminance(picture.at(x, y)) })
  const sorted = lit.toSorted((a, b) => a.value - b.value)
  const [darkest] = sorted
  expectTrue(darkest !== undefined, `${label}: nothing must be lit`)
  // A black half leaves the median to the rest, and a darker part to the brightest twentieth.
  const median = sorted[sorted.length >> 1].value
  const bright = sorted[Math.floor(0.95 * sorted.length)].value
  const { x, y, value } = darkest
  const floor = LEAST * Math.max(median, bright / 20)
  expectTrue(
    value > 0 && value >= floor,
    `${label}: pixel (${x}, ${y}) has ${value}, the median is ${median}, a twentieth has over ${bright}`
  )
  return { median, least: value }
}
