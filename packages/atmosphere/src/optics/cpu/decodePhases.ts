/** Steps of the stored logarithms to the base 2. */
export const LOG_STEPS = 40

/** First character of the stored text, and how many there are. */
export const FIRST_CODE = 35
export const CODES = 57

/**
 * Phase functions from their text: numbers are differences to the ones before, of the logarithm of green, then of red
 * over green and of blue over green. A greatest or least difference goes on in the next character.
 *
 * @param text - Made by scripts/optics/encodePhases.ts.
 * @param samples - Samples of a phase function.
 * @returns Red, green and blue of each sample, one phase function after the other, over sunlight's colour [1/sr].
 */
export function decodePhases(text: string, samples: number): Float32Array {
  const most = (CODES - 1) / 2
  const values: number[] = []
  let difference = 0
  for (const character of text) {
    const code = character.charCodeAt(0) - FIRST_CODE

    const step = code - most
    difference += step
    if (Math.abs(step) < most) {
      values.push(difference)
      difference = 0
    }
  }
  const phases = new Float32Array(values.length)
  const count = values.length / (3 * samples)
  for (let row = 0; row < count; row++) {
    let [green, red, blue] = [0, 0, 0]
    for (let i = 0; i < samples; i++) {
      const at = 3 * (row * samples + i)
      green += values[at]
      red += values[at + 1]
      blue += values[at + 2]
      const logarithms = [green + red, green, green + blue]
      logarithms.forEach((value, k) => (phases[at + k] = 2 ** (value / LOG_STEPS)))
    }
  }
  return phases
}
