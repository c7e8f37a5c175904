declare global {
  /** Samples per texel of three's filter of environments; its own 256 where it is not set. */
  var filterSamples: number | undefined
}

/** Enough that what a rough ball mirrors is within a few per cent. */
const FEW = 32

/**
 * From now on, has three filter environments with an eighth of its samples: at 256 a software renderer
 * takes seconds for one, longer than for all else in most tests.
 *
 * @param isCoarse - False: from now on, as users have it.
 */
export function filterCoarsely(isCoarse: boolean): void {
  globalThis.filterSamples = isCoarse ? FEW : undefined
}
