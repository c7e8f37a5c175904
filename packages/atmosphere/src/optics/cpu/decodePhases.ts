/** Steps of the stored logarithms to the base 2. */
export const LOG_STEPS = 40

/** Code of the character for no difference, and greatest difference of a character. */
export const ZERO_CODE = 63
export const MOST_STEP = 28

/**
 * Number to expect after the last one: that of the sample before, and as much more as the phase function before has grown there.
 *
 * @param numbers - Three of each sample, one phase function after the other.
 * @param at - Place of the number.
 * @param samples - Samples of a phase function.
 */
export function expectedNumber(numbers: readonly number[], at: number, samples: number): number {
  const [before, above, both] = [1, samples, samples + 1].map(n => numbers[at - 3 * n] ?? 0)
  return before + above - both
}

/**
 * Phase functions from their text: numbers are differences to those that `expectedNumber` has, of the logarithm of green, then of red
 * over green and of blue over green. A greatest or least difference goes on in the next character.
 *
 * @param text - Made by scripts/optics/encodePhases.ts.
 * @param samples - Samples of a phase function.
 * @param colorStep - Steps of red and blue, over those of green.
 * @returns Red, green and blue of each sample, one phase function after the other, over sunlight's colour [1/sr].
 */
export function decodePhases(text: string, samples: number, colorStep = 1): Float32Array {
  const numbers: number[] = []
  let difference = 0
  for (const character of text) {
    const step = character.charCodeAt(0) - ZERO_CODE
    difference += step
    if (Math.abs(step) < MOST_STEP) {
      numbers.push(difference + expectedNumber(numbers, numbers.length, samples))
      difference = 0
    }
  }
  return Float32Array.from(numbers, (_, at) => {
    const channel = at % 3
    const green = numbers[at - channel]
    const logarithm =
      channel === 1 ? green : green + colorStep * numbers[channel === 0 ? at + 1 : at]
    return 2 ** (logarithm / LOG_STEPS)
  })
}
