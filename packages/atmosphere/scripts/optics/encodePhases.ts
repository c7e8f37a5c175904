import { expectedNumber, LOG_STEPS, MOST_STEP, ZERO_CODE } from '../../src/optics/cpu/decodePhases'

/** A difference as characters: all but the last are the greatest or least. */
function characters(difference: number): string {
  let [text, left] = ['', difference]
  for (;;) {
    const step = Math.max(-MOST_STEP, Math.min(MOST_STEP, left))
    text += String.fromCharCode(ZERO_CODE + step)
    left -= step
    if (Math.abs(step) < MOST_STEP) return text
  }
}

/**
 * Text of phase functions, for `decodePhases`.
 *
 * @param rows - Red, green and blue of each sample of each [1/sr].
 * @param colorStep - Steps of red and blue, over those of green.
 */
export function encodePhases(
  rows: readonly (readonly (readonly number[])[])[],
  colorStep = 1
): string {
  const numbers = rows.flat().flatMap(color => {
    const [red, green, blue] = color.map(value => Math.log2(value) * LOG_STEPS)
    const stored = Math.round(green)
    const stepsOver = (value: number): number => Math.round((value - stored) / colorStep)
    return [stored, stepsOver(red), stepsOver(blue)]
  })
  return numbers
    .map((value, at) => characters(value - expectedNumber(numbers, at, rows[0].length)))
    .join('')
}
