import { CODES, FIRST_CODE, LOG_STEPS } from '../../src/optics/cpu/decodePhases'

const MOST = (CODES - 1) / 2

/** A difference as characters: all but the last are the greatest or least. */
function characters(difference: number): string {
  let [text, left] = ['', difference]
  for (;;) {
    const step = Math.max(-MOST, Math.min(MOST, left))
    text += String.fromCharCode(FIRST_CODE + MOST + step)
    left -= step
    if (Math.abs(step) < MOST) return text
  }
}

/** Text of phase functions, for `decodePhases`. @param rows - Red, green and blue of each sample of each [1/sr]. */
export function encodePhases(rows: readonly (readonly (readonly number[])[])[]): string {
  return rows
    .map(row => {
      let before = [0, 0, 0]
      return row
        .map(color => {
          const [red, green, blue] = color.map(value => Math.log2(value) * LOG_STEPS)
          const now = [Math.round(green), 0, 0]
          now[1] = Math.round(red) - now[0]
          now[2] = Math.round(blue) - now[0]
          const text = now.map((value, k) => characters(value - before[k])).join('')
          before = now
          return text
        })
        .join('')
    })
    .join('')
}
