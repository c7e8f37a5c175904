import type { CloudFigures, CloudLightFigures } from './cloud-figures'
import type { ColorFigures, SkyComparisons } from './figures'
import type { Band, BandName, Comparison } from './score'

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

/** Largest error of any irradiance with the sun up to this zenith angle [°]. */
export const irradianceGoal = { sunZenith: 93, max: 0.01 }

export const colorGoal = { mean: 0.3, p95: 0.8 }

export interface CloudGoal {
  median?: number
  p90?: number
  p95?: number
}

/** Errors of the radiance that leaves homogeneous clouds, per shape. */
export const cloudGoals: Record<'slab' | 'sphere', CloudGoal> = {
  slab: { median: 0.01, p95: 0.1 },
  sphere: { median: 0.06, p90: 0.25 }
}

/** Errors of the radiance that leaves a simulated cloud, and the largest median of a picture. */
export const cloudLightGoal = { median: 0.1, p90: 0.25, pictureMedian: 0.2 }

/** Goals for light that shadows take from the air, over all light scattered once. */
export const shaftGoal = { median: 0.01, p95: 0.05 }

/** The largest error of irradiance that has a goal; undefined if none has. */
export function worstIrradiance(comparisons: readonly Comparison[]): Comparison | undefined {
  return comparisons
    .filter(comparison => comparison.sunZenith <= irradianceGoal.sunZenith)
    .toSorted((a, b) => Math.abs(b.error) - Math.abs(a.error))[0]
}

/** Names the goals that the figures miss, each with its figure. What was not compared misses none. */
export function missedGoals(
  { irradiance = [] }: SkyComparisons,
  statistics: Record<string, Band[]>,
  colors: ColorFigures | undefined
): string[] {
  const missed: string[] = []
  const hold = (name: string, figure: number, goal: number | undefined): void => {
    if (goal === undefined || figure <= goal) return // NaN meets no goal
    missed.push(`${name} is ${figure.toPrecision(3)}, goal ${goal}`)
  }
  for (const [quantity, bands] of Object.entries(statistics)) {
    for (const figures of bands) {
      const goal = bandGoals[quantity]?.[figures.band] ?? {}
      for (const key of ['median', 'p95', 'max'] as const) {
        hold(`${key} of ${quantity}, sun ${figures.band}°`, figures[key], goal[key])
      }
    }
  }
  const worst = worstIrradiance(irradiance)
  if (worst !== undefined) {
    hold(`irradiance ${worst.label}`, Math.abs(worst.error), irradianceGoal.max)
  }
  if (colors !== undefined) {
    hold('mean of spectral', colors.mean, colorGoal.mean)
    hold('p95 of spectral', colors.p95, colorGoal.p95)
  }
  return missed
}

/** Names the goals that clouds miss, each with its figure. */
export function missedCloudGoals(figures: CloudFigures): string[] {
  return (['slab', 'sphere'] as const).flatMap(shape =>
    Object.entries(cloudGoals[shape]).flatMap(([key, goal]: [string, number]) => {
      const figure = figures[shape][key as keyof CloudGoal]
      if (figure <= goal) return [] // NaN meets no goal
      return [`${key} of cloud ${shape}s is ${figure.toPrecision(3)}, goal ${goal}`]
    })
  )
}

/** Names the goals that a simulated cloud misses, each with its figure. */
export function missedCloudLightGoals({ median, p90, cases }: CloudLightFigures): string[] {
  const pictureMedian = Math.max(...cases.map(picture => picture.median))
  return Object.entries({ median, p90, pictureMedian }).flatMap(([key, figure]) => {
    const goal = cloudLightGoal[key as keyof typeof cloudLightGoal]
    if (figure <= goal) return [] // NaN meets no goal
    return [`${key} of cloud light is ${figure.toPrecision(3)}, goal ${goal}`]
  })
}
