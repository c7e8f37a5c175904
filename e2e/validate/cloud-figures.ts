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
