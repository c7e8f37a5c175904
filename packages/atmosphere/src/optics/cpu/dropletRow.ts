import { dropletData } from '../dropletData'
import { decodePhases } from './decodePhases'
import { DROPLET_RADII } from './dropletRadii'
import { dropletGrid } from './phaseGrid'
import { phaseRow, type PhaseRow } from './phaseRow'

/** Stored phase functions, decoded when first needed. */
let stored: Float32Array | null = null

/** Phase function of droplets. @param radius - Effective radius, within `DROPLET_RADII` [µm]. */
export function dropletRow(radius: number): PhaseRow {
  const numbers = 3 * (dropletGrid.forward + dropletGrid.backward)
  stored ??= decodePhases(dropletData, numbers / 3)
  const last = DROPLET_RADII.length - 1
  const place =
    (Math.log(radius / DROPLET_RADII[0]) / Math.log(DROPLET_RADII[last] / DROPLET_RADII[0])) * last
  const row = Math.min(Math.floor(place), last - 1)
  // Two populations side by side: the sizes of neighbours overlap.
  const colors = Array.from({ length: numbers }, (_, i) => {
    const [a, b] = [row, row + 1].map(n => stored![numbers * n + i])
    return a + (b - a) * (place - row)
  })
  return phaseRow(colors, dropletGrid)
}
