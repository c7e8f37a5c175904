import type { PhaseGrid } from './phaseGrid'

/** Rates of rain whose phase functions are stored [mm/h]. */
export const RAIN_RATES: readonly number[] = [0.5, 5, 50]

/** Grid of stored rain: bows are on the side away from the light. */
export const rainGrid: PhaseGrid = { forward: 40, backward: 256 }
