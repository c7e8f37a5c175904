import fc from 'fast-check'

/** Seed and number of cases: the same cases in every run; a failure still prints its counterexample. */
export const runs = { seed: 20260621, numRuns: 300 }

export const number = (min: number, max: number): fc.Arbitrary<number> =>
  fc.double({ min, max, noNaN: true, noDefaultInfinity: true })

export const cosine = number(-1, 1)
export const spectrumIndex = [0, 1, 2, 3] as const
