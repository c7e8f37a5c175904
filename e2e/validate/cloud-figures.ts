import type { CloudCase } from './cloud-reference'

/** Relative errors of cases; fractions. */
export interface CloudStatistics {
  n: number
  median: number
  p90: number
  p95: number
}

export type CloudResult = CloudCase & { model: number; error: number }

export interface CloudFigures {
  slab: CloudStatistics
  sphere: CloudStatistics
  cases: CloudResult[]
}

/** Relative errors of a picture's blocks; fractions. */
export interface CloudLightCase {
  /** Elevation of the sun; azimuth and angle below the horizon of the view [°]. */
  sun: number
  view: { azimuth: number; down: number }
  n: number
  median: number
  p90: number
  /** Median of error with its sign: above 0 where the picture is too bright. */
  bias: number
  /** All light of the blocks over that of the reference. */
  total: number
}

export interface CloudLightFigures {
  n: number
  median: number
  p90: number
  /** Median of the reference's own standard error over its radiance. */
  stderr: number
  cases: CloudLightCase[]
}
