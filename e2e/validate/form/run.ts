import type { CloudPresetName } from '@welkin/clouds'
import type { Backend } from '../../harness/backend'
import { drawCloudFields } from '../cloud-field'
import { quantile } from '../score'
import { formFigures, type FormFigures } from './figures'

/** Places whose clouds may be judged: apart, at several latitudes, and in pairs where there are neither few nor many. */
const PLACES = [
  [139.77, 35.68],
  [-60, 14],
  [-60.2, 14.2],
  [-120, 5],
  [-30, -15],
  [-30.2, -15.2],
  [-90, 40],
  [-90.2, 40.2],
  [30, 10],
  [30.2, 10.2]
] as const

/** Width of a window and of a cell [m]. */
const SIZE = 6000
const CELL = 20

/** Cover that a window must have to count, and how many such windows are judged. */
const COVER = [0.1, 0.35] as const
const WINDOWS = 5

/** A figure's name, how it is read, and where a field that passes for a simulated one must lie. */
const rows: [string, (figures: FormFigures) => number, number, number][] = [
  ['dimension, horizontal sections', f => f.horizontalDimension, 1.3, 1.52],
  ['dimension, vertical sections', f => f.verticalDimension, 1.3, 1.6],
  ['boundary left after 20 m', f => f.boundaryLeft[0], -Infinity, Infinity],
  ['boundary left after 40 m', f => f.boundaryLeft[1], 0, 0.45],
  ['boundary left after 80 m', f => f.boundaryLeft[2], 0, 0.22],
  ['height of the largest fraction', f => f.peakHeight, 0, 0.2],
  ['fraction at mid-height over it', f => f.midOverPeak, 0, 0.6],
  ['extinction, 0.8 over 0.2 of height', f => f.extinctionRise, 1.3, Infinity],
  ['height over width', f => f.aspect, 0.6, 1.1],
  ['slope of sizes', f => f.sizeSlope, -2.4, -1.2],
  ['detached volume', f => f.detached, 0, 0.13],
  ['pieces per km²', f => f.piecesPerKm2, 2.5, 9],
  ['slope of depths, 500 to 125 m', f => f.spectrumSlope, -2.3, -1.5],
  ['extinction 40–80 m inside', f => f.interior[2], 0.8, Infinity],
  ['extinction 80–160 m inside', f => f.interior[3], 0.8, Infinity]
]

/** A figure over all windows. */
export interface FormRow {
  name: string
  median: number
  values: number[]
  range: [number, number]
  isMet: boolean
}

/** Figures of a preset's form, as the GPU draws it. */
export interface FormResult {
  preset: CloudPresetName
  covers: number[]
  rows: FormRow[]
}

/** Judges the form of a preset by windows with neither few nor many clouds. */
export async function validateForm(
  preset: CloudPresetName,
  backend: Backend,
  coverage?: number
): Promise<FormResult> {
  const covers: number[] = []
  const judged: FormFigures[] = []
  const about = { backend, preset, size: SIZE, cell: CELL, coverage }
  const requests = PLACES.map(([longitude, latitude]) =>
    Object.assign({ longitude, latitude }, about)
  )
  await drawCloudFields(requests, grid => {
    if (grid.data.every(value => value === 0)) return false
    const figures = formFigures(grid)
    covers.push(figures.cover)
    if (figures.cover >= COVER[0] && figures.cover <= COVER[1]) judged.push(figures)
    return judged.length === WINDOWS
  })
  if (judged.length === 0) {
    const list = covers.map(cover => cover.toFixed(2)).join(', ')
    throw new Error(
      `--form: no window of ${preset} has a cover from ${COVER.join(' to ')}, but ${list}: give --coverage`
    )
  }
  return {
    preset,
    covers: judged.map(({ cover }) => cover),
    rows: rows.map(([name, read, low, high]) => {
      const values = judged.map(read)
      const known = values.filter(Number.isFinite)
      const median = known.length > 0 ? quantile(known, 0.5) : NaN
      return { name, median, values, range: [low, high], isMet: median >= low && median <= high }
    })
  }
}

/** Prints a row per figure: median, limits, and each window's value. */
export function printForm({ preset, covers, rows: all }: FormResult): void {
  const list = (values: number[]): string => values.map(value => value.toFixed(2)).join('  ')
  console.log(`Form of ${preset}, medians of ${covers.length} windows of cover ${list(covers)}\n`)
  console.log(`  ${''.padEnd(36)} median   must be        each`)
  for (const { name, median, range, values, isMet } of all) {
    const [low, high] = range.map(limit => (Number.isFinite(limit) ? String(limit) : ''))
    const limits = low === '' && high === '' ? '' : `${low}…${high} ${isMet ? '✓' : '✗'}`
    console.log(
      `  ${name.padEnd(36)} ${median.toFixed(2).padStart(6)}   ${limits.padEnd(13)}  ${list(values)}`
    )
  }
}
