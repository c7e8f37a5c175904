import { MathUtils } from 'three'
import { stormPlaces, stormShape } from '../density/stormForm'
import type { CloudLayerParameters } from './CloudLayer'
import { layerPeriods, noisePeriods } from './layerUniforms'

// Storms in float64: functions of density/tsl/storm.ts of the same names.

/** True for layers of storms: those of the weather of cumulonimbus alone. */
export const isStorm = ({ weatherWeights: [a, b, c, d] }: CloudLayerParameters): boolean =>
  c > 0 && a + b + d === 0

/** Length of a cell of the lattice that storms stand in [m]. */
export const stormCell = (layer: CloudLayerParameters): number =>
  (layerPeriods(layer).weather * noisePeriods.fields) / stormPlaces.cells

/**
 * Radius of storms [m].
 *
 * @param background - Part of the weather's sum on scales larger than single clouds.
 * @param weight - Factor of single clouds in that sum.
 */
export function stormRadius(
  layer: CloudLayerParameters,
  background: number,
  coverage: number,
  weight: number
): number {
  const { scale, power, ranks } = stormPlaces
  const odds = MathUtils.clamp(coverage, 1e-6, 1 - 1e-6)
  const quantile = Math.log(odds / (1 - odds)) / 1.702
  const rank = MathUtils.clamp(0.5 - (background + quantile) / weight, ...ranks)
  return (-Math.log(rank)) ** (1 / power) * scale * stormCell(layer)
}

/** Distance into a storm's body, without billows [m]; negative outside. Distances from the axes of anvil and tower [m]. */
export function stormBody(
  { baseAltitude, topAltitude, anvil: share }: CloudLayerParameters,
  distance: number,
  radius: number,
  height: number,
  towerDistance = distance
): number {
  const { tower, leastTower, widening, narrowing, dome, anvil, above, below, blend } = stormShape
  const { anvilFrom, grown, least } = stormShape
  const thickness = topAltitude - baseAltitude
  const tall = thickness * Math.max(Math.sqrt(Math.min(radius / thickness / grown, 1)), least)
  const y = height * thickness
  const narrow = Math.max(tower * radius, Math.min(leastTower * thickness, radius))
  const base = MathUtils.lerp(radius, narrow, share)
  const wide = MathUtils.lerp(
    base,
    radius,
    share * MathUtils.smoothstep(radius / thickness, ...anvilFrom)
  )
  const [atBase, atTop] = [0, 1].map(end => MathUtils.lerp(narrowing[end], widening[end], share))
  const column = base * MathUtils.lerp(atBase, atTop, height)
  const inTower =
    column - Math.hypot(towerDistance, Math.max(y - Math.max(dome * tall - column, 0), 0))
  const rise = y - anvil * tall
  const depth = tall * (rise > 0 ? above : below)
  const norm = Math.hypot(distance / wide, rise / depth)
  const gradient = Math.max(Math.hypot(distance / wide ** 2, rise / depth ** 2), 1e-6)
  const inAnvil = ((1 - norm) * norm) / gradient
  const soft = blend * tall
  const part = MathUtils.clamp(0.5 + (0.5 * (inTower - inAnvil)) / soft, 0, 1)
  return MathUtils.lerp(inAnvil, inTower, part) + soft * part * (1 - part)
}
