import type { BandName } from './score'

/** Largest errors that the project accepts; fractions, or ΔE. */
export interface Goal {
  median?: number
  p95?: number
  max?: number
}

/** Goals per quantity and band of sun angles. */
export const bandGoals: Record<string, Partial<Record<BandName, Goal>>> = {
  sky: {
    '0-80': { median: 0.005, p95: 0.02 },
    '84-90': { median: 0.007, p95: 0.03 },
    '91-95': { median: 0.015, p95: 0.1 }
  },
  inscatter: { '0-80': { median: 0.01, p95: 0.04 } },
  transmittance: { '0-80': { p95: 0.005 }, '84-90': { p95: 0.005 }, '91-95': { p95: 0.005 } }
}

/** Of every value of irradiance with the sun up to this zenith angle [°]. */
export const irradianceGoal = { sunZenith: 93, max: 0.01 }

export const colorGoal = { mean: 0.3, p95: 0.8 }

export interface CloudGoal {
  median?: number
  p90?: number
  p95?: number
}

/** Of radiances out of homogeneous clouds, per shape. */
export const cloudGoals: Record<'slab' | 'sphere', CloudGoal> = {
  slab: { median: 0.03, p95: 0.15 },
  sphere: { median: 0.2, p90: 0.6 }
}
