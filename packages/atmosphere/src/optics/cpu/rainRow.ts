import { rainData } from '../rainData'
import { decodePhases } from './decodePhases'
import { phaseRow, type PhaseRow } from './phaseRow'
import { RAIN_COLOR_STEP, RAIN_RATES, rainGrid } from './rainRates'

/** Phase function of rain. @param rate - Beyond `RAIN_RATES`, that of the nearer end [mm/h]. */
export function rainRow(rate: number): PhaseRow {
  const numbers = 3 * (rainGrid.forward + rainGrid.backward)
  const stored = decodePhases(rainData, numbers / 3, RAIN_COLOR_STEP)
  const last = RAIN_RATES.length - 1
  const [least, most] = [RAIN_RATES[0], RAIN_RATES[last]]
  const within = Math.min(Math.max(rate, least), most)
  const place = (Math.log(within / least) / Math.log(most / least)) * last
  const row = Math.min(Math.floor(place), last - 1)
  const colors = Array.from({ length: numbers }, (_, i) => {
    const [a, b] = [row, row + 1].map(n => stored[numbers * n + i])
    return a + (b - a) * (place - row)
  })
  return phaseRow(colors, rainGrid)
}
