import type { PhaseGrid } from './phaseGrid'

/** Rates of rain whose phase functions are stored, a decade apart [mm/h]. */
export const RAIN_RATES: readonly number[] = [0.5, 5, 50]

/** Grid of stored rain: bows are on the side away from the light. */
export const rainGrid: PhaseGrid = { forward: 40, backward: 256 }

/** Steps of red and blue in the stored rain, over those of green: 3.5 % of the light. */
export const RAIN_COLOR_STEP = 2
