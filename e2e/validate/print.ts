import type { ColorFigures, SkyComparisons } from './figures'
import { bandGoals, colorGoal, irradianceGoal, worstIrradiance, type Goal } from './goals'
import type { Band, Comparison } from './score'

const titles: Record<string, string> = {
  sky: 'Sky radiance',
  inscatter: 'In-scatter of segments',
  transmittance: 'Transmittance of segments',
  irradiance: 'Irradiance of the ground, by the sky, and by sky and sun'
}

const percent = (value: number): string => {
  const digits = value < 0.000_995 ? 3 : value < 0.0995 ? 2 : 1
  return `${(100 * value).toFixed(digits)} %`
}
const cell = (text: string, width: number): string => text.padStart(width)

/** A figure with its goal and a mark. */
function judged(
  value: number,
  goal: number | undefined,
  format: (value: number) => string
): string {
  if (goal === undefined) return cell(format(value), 10).padEnd(24)
  const mark = value <= goal ? '✓' : '✗'
  return `${cell(format(value), 10)} ${`≤ ${format(goal)}`.padEnd(10)}${mark}`.padEnd(24)
}

function printBands(bands: Band[], goals: Partial<Record<string, Goal>>): void {
  const head = ['    median'.padEnd(24), '       p95'.padEnd(24), '       max'.padEnd(24)]
  console.log(`  ${'sun'.padEnd(8)}${cell('n', 6)}${head.join('')}${cell('ref. error', 11)}`)
  for (const { band, n, median, p95, max, stderr } of bands) {
    const goal = goals[band] ?? {}
    const figures = [
      judged(median, goal.median, percent),
      judged(p95, goal.p95, percent),
      judged(max, goal.max, percent)
    ]
    const name = `${band.replace('-', '–')}°`.padEnd(8)
    console.log(`  ${name}${cell(String(n), 6)}${figures.join('')}${cell(percent(stderr), 11)}`)
  }
}

function printIrradianceGoal(comparisons: Comparison[]): void {
  const worst = worstIrradiance(comparisons)
  if (worst === undefined) return
  const figure = judged(Math.abs(worst.error), irradianceGoal.max, percent).trim()
  console.log(`  largest up to ${irradianceGoal.sunZenith}°: ${figure}  (${worst.label})`)
}

/** Prints a table per quantity. */
export function printQuantities(
  comparisons: SkyComparisons,
  statistics: Record<string, Band[]>
): void {
  for (const [name, bands] of Object.entries(statistics)) {
    console.log(titles[name])
    printBands(bands, bandGoals[name] ?? {})
    if (name === 'irradiance') printIrradianceGoal(comparisons.irradiance ?? [])
    console.log()
  }
}

/** Prints how far off the sun alone is, per angle. */
export function printSun(comparisons: Comparison[]): void {
  const zeniths = [...new Set(comparisons.map(({ sunZenith }) => sunZenith))]
  if (zeniths.length === 0) return
  console.log(
    'Irradiance of the ground by the sun alone, all light from the middle of its disc: no goal'
  )
  for (const zenith of zeniths) {
    const errors = comparisons.filter(({ sunZenith }) => sunZenith === zenith)
    const text = errors.map(({ error }) => cell(`${(100 * error).toFixed(2)} %`, 11)).join('')
    console.log(`  ${`${zenith}°`.padEnd(8)}${text}`)
  }
  console.log()
}

/** Prints the colour differences. */
export function printColors({ n, mean, p95, max }: ColorFigures): void {
  const format = (value: number): string => value.toFixed(2)
  console.log('Colour of the sky, ΔE2000')
  console.log(`  n ${n}`)
  console.log(`  mean ${judged(mean, colorGoal.mean, format)}`)
  console.log(`  p95  ${judged(p95, colorGoal.p95, format)}`)
  console.log(`  max  ${judged(max, undefined, format)}`)
}

/** Lists the largest errors. */
export function printWorst(name: string, comparisons: Comparison[], count: number): void {
  const worst = [...comparisons].sort((a, b) => Math.abs(b.error) - Math.abs(a.error))
  if (count > 0) console.log(`\nLargest errors: ${titles[name]}`)
  for (const { error, stderr, label } of worst.slice(0, count)) {
    console.log(`  ${cell(`${(100 * error).toFixed(1)} %`, 9)} ± ${percent(stderr)}  ${label}`)
  }
}
