declare global {
  /** Samples of three's filter of environments, and edge of faces; where it is not set, 256, and 16 texels. */
  var filterSamples: { samples: number; edge: number } | undefined
}

/**
 * Samples per texel, and edge of the faces whose texels are summed up for what is rough, with which reflections on a rough ball are
 * within a few per cent.
 */
const FEW = { samples: 32, edge: 8 }

/** As few as will do where reflections need no more than light of the sky. */
const LEAST = { samples: 8, edge: 4 }

/**
 * Has three, from now on, filter environments with an eighth of its samples, and a quarter of them for what is rough: with all, a
 * software renderer takes seconds for one, longer than for all else in most tests.
 *
 * @param isCoarse - False: from now on, as users have it.
 */
export function filterCoarsely(isCoarse: boolean): void {
  globalThis.filterSamples = isCoarse ? FEW : undefined
}

/** Has three filter environments with a quarter of those samples again, until the test ends: for when and whether there is light, not how much. */
export function filterLeast(): void {
  globalThis.filterSamples = LEAST
}
