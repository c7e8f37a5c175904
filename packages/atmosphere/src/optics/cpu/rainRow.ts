import { MathUtils } from 'three'
import { rainData } from '../rainData'
import { decodePhases } from './decodePhases'
import { phaseRow, type PhaseRow } from './phaseRow'
import { RAIN_COLOR_STEP, RAIN_RATES, rainGrid } from './rainRates'

/** Phase function of rain. @param rate - Beyond `RAIN_RATES`, that of the nearer end [mm/h]. */
export function rainRow(rate: number): PhaseRow {
  const numbers = 3 * (rainGrid.forward + rainGrid.backward)
  const stored = decodePhases(rainData, numbers / 3, RAIN_COLOR_STEP)
  const last = RAIN_RATES.length - 1
  const place = MathUtils.clamp(Math.log10(rate / RAIN_RATES[0]), 0, last)
  const row = Math.min(Math.floor(place), last - 1)
  const from = numbers * row
  const colors = stored
    .slice(from, from + numbers)
    .map((value, i) => MathUtils.lerp(value, stored[from + numbers + i], place - row))
  return phaseRow(colors, rainGrid)
}
