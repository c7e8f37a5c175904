import { describe, expect, it } from 'vitest'
import { missedCloudGoals, missedGoals } from '../validate/goals'
import { bandStatistics, type Comparison } from '../validate/score'

const errors = (sunZenith: number, error: number): Comparison[] =>
  Array.from({ length: 20 }, () => ({ sunZenith, error, stderr: 0, label: `sun ${sunZenith}°` }))

function missed(quantity: 'sky' | 'irradiance', comparisons: Comparison[]): string[] {
  const quantities = { [quantity]: comparisons }
  return missedGoals(quantities, { [quantity]: bandStatistics(comparisons) }, undefined)
}

describe('missedGoals', () => {
  it('has nothing to say of what was not compared', () => {
    expect(missedGoals({}, {}, undefined)).toEqual([])
  })

  it('holds each band to its own goals, whatever the sign', () => {
    expect(missed('sky', errors(30, 0.004))).toEqual([])
    expect(missed('sky', errors(30, -0.006))).toEqual([
      'median of sky, sun 0-80° is 0.00600, goal 0.005'
    ])
    expect(missed('sky', errors(85, 0.006))).toEqual([])
    expect(missed('sky', errors(97.5, 0.5))).toEqual([])
  })

  it('holds the worst irradiance up to 93°', () => {
    expect(missed('irradiance', [...errors(90, 0.009), ...errors(94, 0.5)])).toEqual([])
    expect(missed('irradiance', [...errors(90, 0.009), ...errors(92, -0.011)])).toHaveLength(1)
  })

  it('holds mean and p95 of the colours, not their maximum', () => {
    const figures = { n: 10, mean: 0.29, p95: 0.79, max: 9 }
    expect(missedGoals({}, {}, figures)).toEqual([])
    expect(missedGoals({}, {}, { ...figures, mean: 0.31 })).toHaveLength(1)
    expect(missedGoals({}, {}, { ...figures, p95: NaN })).toHaveLength(1)
  })
})

describe('missedCloudGoals', () => {
  it('holds slabs and spheres to what they were at when clouds got their form', () => {
    const slab = { n: 10, median: 0.006, p90: 0.054, p95: 0.084 }
    const sphere = { n: 10, median: 0.044, p90: 0.195, p95: 0.265 }
    const cases: never[] = []
    expect(missedCloudGoals({ slab, sphere, cases })).toEqual([])
    expect(missedCloudGoals({ slab, sphere: { ...sphere, p90: 0.287 }, cases })).toEqual([
      'p90 of cloud spheres is 0.287, goal 0.25'
    ])
    expect(missedCloudGoals({ slab: { ...slab, median: 0.02 }, sphere, cases })).toHaveLength(1)
  })
})
