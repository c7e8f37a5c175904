import { expectTrue } from './expect'
import type { Picture } from './picture'
import { covers, isKnown, predict, type FeatureName, type Part } from './predict'

/**
 * Change of a pixel that counts as one, and the error of what is predicted, over its brightness: a picture is rounded to half floats,
 * by up to 1/2048 each time, in eight places.
 */
export const CHANGE = 3e-4
const TOLERANCE = 8 / 2048
/** Error with clouds, whose shadows follow the sun over some frames. */
const CLOUD_TOLERANCE = 0.03
/** Part of a drop's light from behind that it sends on, as the overlay has it: drops hide by more what is darker than they are. */
const FORWARD = 0.65
/**
 * Most that media scatter into a pixel of the moon's light, over that in the pixel of its disc, of 0.006 sr: forwards an asymmetry of 0.9
 * gives 15 / sr.
 */
const SCATTERED = 0.1
/** The moon's disc is where its light is more than that part of the most. */
const DISC = 1e-3
/** Part of the light behind them that features let through, by number of a picture. */
type Passing = ReadonlyMap<FeatureName, Float32Array>

/** Part of the light behind features that passes them: their light over white less that over what is there, beside the same without them. */
export function measurePassing(
  pictureOf: (names: FeatureName[], isWhite: boolean) => Picture
): Map<FeatureName, Float32Array> {
  const added = (names: FeatureName[]): Float32Array => {
    const [white, black] = [true, false].map(isWhite => pictureOf(names, isWhite).data)
    return white.map((value, i) => value - black[i])
  }
  const clear = added([])
  clear.forEach((value, i) => {
    const isBright = value > 100 && value < 5e4
    if (i % 4 !== 3) expectTrue(isBright, `number ${i} over white is brighter by ${value}`)
  })
  return new Map(
    covers.map(name => [name, added([name]).map((value, i) => Math.min(value / clear[i], 1))])
  )
}

/** Brightest number that a feature adds in a picture. */
function brightest(picture: Picture, none: Picture): number {
  return picture.data.reduce((most, value, i) => Math.max(most, value - none.data[i]), 0)
}

/** A feature alone, for each number of a picture. */
function partsOf(
  name: FeatureName,
  alone: Picture,
  none: Picture,
  passing: Passing
): (i: number) => Part {
  const passed = passing.get(name)
  const most = brightest(alone, none)
  return i => {
    const part = { name, value: alone.data[i] }
    if (name === 'moon') {
      const isDisc = part.value - none.data[i] > DISC * most
      return { ...part, passes: [isDisc ? 0 : 1, 1], scattered: SCATTERED * most }
    }
    if (passed === undefined) return part
    const through = passed[i]
    const least = name === 'drops' ? Math.max(1 - (1 - through) / (1 - FORWARD), 0) : through
    return { ...part, passes: [least, through] }
  }
}

export interface Checked {
  /** Share of numbers that are known, and of those which two features or more change. */
  known: number
  mixed: { known: number; all: number }
  /** First number that is wrong. */
  wrong: string | undefined
}

/** Compares a picture of features with those of each alone. */
export function checkPicture(
  names: readonly FeatureName[],
  drawn: Picture,
  none: Picture,
  singles: readonly Picture[],
  passing: Passing
): Checked {
  const hasClouds = names.includes('clouds') || names.includes('lightning')
  const tolerance = hasClouds ? CLOUD_TOLERANCE : TOLERANCE
  const partAt = names.map((name, k) => partsOf(name, singles[k], none, passing))
  let known = 0
  const mixed = { known: 0, all: 0 }
  let wrong: string | undefined
  for (let i = 0; i < drawn.data.length; i++) {
    if (i % 4 === 3) continue
    const parts = partAt.map(at => at(i))
    // Rounding is that of the pixel's brightest part: colours mix.
    const first = i - (i % 4)
    const bright = Math.max(
      ...[none, drawn, ...singles].map(({ data }) => Math.max(...data.subarray(first, first + 3)))
    )
    const changing = parts.filter(part => Math.abs(part.value - none.data[i]) > CHANGE * bright)
    if (changing.length > 1) mixed.all++
    // What is black in one channel of a colour may be less than that: sRGB has no such colour.
    const isCut = ({ data }: Picture, value: number): boolean =>
      value === 0 && data.subarray(first, first + 3).some(other => other > 0)
    if (singles.some((single, k) => isCut(single, parts[k].value))) continue
    const range = predict(none.data[i], parts, CHANGE * bright)
    if (range === null) continue
    const error = tolerance * bright
    if (isKnown(range, CHANGE * bright)) {
      known++
      if (changing.length > 1) mixed.known++
    }
    const [least, most] = range
    const value = drawn.data[i]
    const [x, y] = [(first >> 2) % drawn.width, Math.floor((first >> 2) / drawn.width)]
    if (value >= least - error && value <= most + error) continue
    const alone = parts.map(
      part =>
        `${part.value.toPrecision(4)} (passes ${part.passes?.map(each => each.toPrecision(3))})`
    )
    const found = `${value.toPrecision(4)}, not in [${least.toPrecision(4)}, ${most.toPrecision(4)}]`
    wrong ??= `channel ${i % 4} of (${x}, ${y}) is ${found}; without ${none.data[i].toPrecision(4)}, alone ${alone.join(', ')}; all of the pixel ${[...drawn.data.subarray(first, first + 3)].map(value => value.toPrecision(3)).join(', ')}`
  }
  return { known: known / (0.75 * drawn.data.length), mixed, wrong }
}
