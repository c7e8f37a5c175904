import { rainData } from '../rainData'
import { decodePhases } from './decodePhases'
import { phaseRow, type PhaseRow } from './phaseRow'
import { RAIN_RATES, rainGrid } from './rainRates'

/** Phase function of rain. @param rate - Within `RAIN_RATES` [mm/h]. */
export function rainRow(rate: number): PhaseRow {
  const numbers = 3 * (rainGrid.forward + rainGrid.backward)
  const stored = decodePhases(rainData, numbers / 3)
  const last = RAIN_RATES.length - 1
  const place = (Math.log(rate / RAIN_RATES[0]) / Math.log(RAIN_RATES[last] / RAIN_RATES[0])) * last
  const row = Math.min(Math.floor(place), last - 1)
  const colors = Array.from({ length: numbers }, (_, i) => {
    const [a, b] = [row, row + 1].map(n => stored[numbers * n + i])
    return a + (b - a) * (place - row)
  })
  return phaseRow(colors, rainGrid)
}
