import type { Backend } from '../harness/backend'
import type { CloudFigures, CloudResult, CloudStatistics } from './cloud-figures'
import { readCloudReference } from './cloud-reference'
import { cloudGoals, type CloudGoal } from './goals'
import type { CloudRequest } from './page/clouds'
import { withPages } from './pages'
import { quantile } from './score'

/** References below this part of the sun's irradiance are left out. */
const NEGLIGIBLE = 1e-7

/** Exits nearer to a slab's horizon than this are reported, but not scored [°]. */
const LARGEST_EXIT = 75

function statistics(cases: readonly CloudResult[]): CloudStatistics {
  const errors = cases.map(({ error }) => Math.abs(error))
  const part = (share: number): number => (errors.length === 0 ? NaN : quantile(errors, share))
  return { n: errors.length, median: part(0.5), p90: part(0.9), p95: part(0.95) }
}

const isScored = ({ exitZenith }: CloudResult): boolean => exitZenith <= LARGEST_EXIT

/** Marches the clouds of a file through the lighting code on the GPU. */
export async function validateClouds(file: string, backend: Backend): Promise<CloudFigures> {
  const { phases, cases } = readCloudReference(file)
  const request: CloudRequest = {
    backend,
    phases,
    rays: cases.map(({ shape, phase, input }) => ({ shape, phase, input }))
  }
  const radiances = await withPages('welkinClouds', async open =>
    (await open()).evaluate(asked => window.welkinClouds(asked), request)
  )
  const results = cases.flatMap((item, i) => {
    if (!(item.reference >= NEGLIGIBLE)) return []
    const error = (radiances[i] - item.reference) / item.reference
    if (!Number.isFinite(error)) throw new Error(`clouds: the model gave ${radiances[i]}`)
    return [{ ...item, model: radiances[i], error }]
  })
  const of = (shape: string): CloudStatistics =>
    statistics(results.filter(result => result.shape === shape && isScored(result)))
  return { slab: of('slab'), sphere: of('sphere'), cases: results }
}

const percent = (value: number): string => `${(100 * value).toFixed(1)} %`.padStart(9)

/** Prints the scores of slabs and spheres. */
export function printClouds(figures: CloudFigures): void {
  for (const shape of ['slab', 'sphere'] as const) {
    const goal: CloudGoal = cloudGoals[shape]
    const scored = figures.cases.filter(result => result.shape === shape && isScored(result))
    const row = (name: string, { n, median, p90, p95 }: CloudStatistics): string =>
      `  ${name.padEnd(34)}${String(n).padStart(5)}${[median, p90, p95].map(percent).join('')}`
    console.log(
      shape === 'slab'
        ? `Radiance of cloud slabs, exits to ${LARGEST_EXIT}°`
        : '\nRadiance of spheres of cloud'
    )
    console.log(`  ${''.padEnd(34)}    n   median      p90      p95`)
    console.log(row('all', figures[shape]))
    const by = (name: string, key: (result: CloudResult) => string | number): void => {
      const values = [...new Set(scored.map(key))]
      for (const value of values.toSorted((a, b) => (a < b ? -1 : 1))) {
        const some = scored.filter(result => key(result) === value)
        console.log(row(`${name} ${value}`, statistics(some)))
      }
    }
    by(shape === 'slab' ? 'thickness' : 'diameter', ({ tau }) => tau)
    by('phase', ({ phase }) => phase)
    by(shape === 'slab' ? 'sun zenith' : 'angle from sun', ({ sunAngle }) => sunAngle)
    for (const key of ['median', 'p90', 'p95'] as const) {
      const limit = goal[key]
      if (limit === undefined) continue
      const met = figures[shape][key] <= limit
      console.log(`  goal: ${key} ≤ ${percent(limit).trim()} ${met ? '✓' : '✗'}`)
    }
  }
  console.log()
}
