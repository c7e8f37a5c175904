declare global {
  /** Samples per texel of three's filter of environments; its own 256 where it is not set. */
  var filterSamples: number | undefined
}

/** Number of samples with which reflections on a rough ball are within a few per cent. */
const FEW = 32

/**
 * Has three, from now on, filter environments with an eighth of its samples: at 256 a software renderer
 * takes seconds for one, longer than for all else in most tests.
 *
 * @param isCoarse - False: from now on, as users have it.
 */
export function filterCoarsely(isCoarse: boolean): void {
  globalThis.filterSamples = isCoarse ? FEW : undefined
}
