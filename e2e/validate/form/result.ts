import type { CloudPresetName } from '@welkin/clouds'
import { quantile } from '../score'
import type { FormFigures } from './figures'

/** Cover that a window must have to count, and how many such windows are judged. */
export const COVER = [0.1, 0.35] as const
export const WINDOWS = 5

/** Preset whose figures have limits: those of simulated trade-wind cumulus say nothing of other clouds. */
export const JUDGED: CloudPresetName = 'fairWeather'

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

/**
 * Medians over windows. A figure that is not known in so many windows as are judged does not meet its limits.
 *
 * @param covers - Covers of all windows that were drawn.
 * @throws If there are fewer windows than are judged.
 */
export function formResult(
  preset: CloudPresetName,
  judged: readonly FormFigures[],
  covers: readonly number[]
): FormResult {
  if (judged.length < WINDOWS) {
    const list = covers.map(cover => cover.toFixed(2)).join(', ')
    throw new Error(
      `--form: only ${judged.length} of ${WINDOWS} windows of ${preset} have a cover from ${COVER.join(' to ')}, of ${list}: give --coverage`
    )
  }
  return {
    preset,
    covers: judged.map(({ cover }) => cover),
    rows: rows.map(([name, read, ...limits]) => {
      const values = judged.map(read)
      const known = values.filter(Number.isFinite)
      const median = known.length > 0 ? quantile(known, 0.5) : NaN
      const range: [number, number] = preset === JUDGED ? limits : [-Infinity, Infinity]
      const isMet = known.length >= WINDOWS && median >= range[0] && median <= range[1]
      return { name, median, values, range, isMet: isMet || preset !== JUDGED }
    })
  }
}
