import type { CloudPresetName } from '@welkin/clouds'
import type { Backend } from '../../harness/backend'
import { drawCloudFields } from '../cloud-field'
import { formFigures, type FormFigures } from './figures'
import { COVER, formResult, JUDGED, WINDOWS, type FormResult } from './result'

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
  return formResult(preset, judged, covers)
}

/** Prints a row per figure: median, limits, and each window's value. */
export function printForm({ preset, covers, rows: all }: FormResult): void {
  const list = (values: number[]): string => values.map(value => value.toFixed(2)).join('  ')
  console.log(`Form of ${preset}, medians of ${covers.length} windows of cover ${list(covers)}\n`)
  if (preset !== JUDGED)
    console.log(`  Limits are those of ${JUDGED}: there are none for other clouds.\n`)
  console.log(`  ${''.padEnd(36)} median   must be        each`)
  for (const { name, median, range, values, isMet } of all) {
    const [low, high] = range.map(limit => (Number.isFinite(limit) ? String(limit) : ''))
    const limits = low === '' && high === '' ? '' : `${low}…${high} ${isMet ? '✓' : '✗'}`
    console.log(
      `  ${name.padEnd(36)} ${median.toFixed(2).padStart(6)}   ${limits.padEnd(13)}  ${list(values)}`
    )
  }
}
