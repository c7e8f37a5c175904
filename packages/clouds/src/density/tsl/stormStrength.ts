import { smoothstep } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { stormBillows, stormIce } from '../stormForm'
import { heightForm } from '../formConstants'
import type { Float } from '../../tsl-types'
import type { Billows } from './billows'
import { iceAt } from './heightForm'
import type { LayerNodes } from './layer'
import { stormBody } from './storm'
import { frayedDistance } from './stormFibres'
import type { CloudWeather } from './weather'

/** Strength of a storm at a place, as of `LayerSample`, in lengths of `stormBillows.unit`. */
export interface StormStrength {
  /** With all billows [–]. */
  readonly strength: Float
  /** Strength of detail, per deviation of its noise [–]. */
  readonly detail: Float
  /** Strength over which density rises at the edge [–]. */
  readonly edge: Float
  /** Factor of the density that clouds have at the height [–]. */
  readonly density: Float
}

/** Strength of a storm without billows [–]: its distance into the body. */
export const smoothStormStrength = (
  layer: LayerNodes,
  {
    stormDistance,
    towerDistance,
    stormRadius
  }: Pick<CloudWeather, 'stormDistance' | 'towerDistance' | 'stormRadius'>,
  height: Float
): Float =>
  stormBody(stormDistance, towerDistance, stormRadius, height, layer.thickness, layer.anvil)
    .mul(layer.perShapePeriod.div(stormBillows.unit))
    .sub(layer.shapeAmount.mul(stormBillows.offset))
    .toConst()

/**
 * Density of a storm over what its layer has at a height [–]: that of water by its tower, and less and less ice towards the anvil's
 * rim.
 *
 * @param all - `iceAt`.
 * @param ice - Share of ice there.
 * @param inRadii - Distance from the anvil's axis, in its radii.
 * @param fromTower - Distance from the tower's axis, in the same.
 */
function stormDensity(all: Float, ice: Float, inRadii: Float, fromTower: Float): Float {
  const { rim, end, least, streaming } = stormIce
  const width = fromTower.clamp(...streaming).mul(rim)
  const inside = inRadii.negate().add(end).div(width).clamp(least, 1).toConst() as Float
  const ofHeight = all.mix(1, heightForm.iceDensity)
  return ice.mix(1, inside.mul(inside).mul(heightForm.iceDensity)).div(ofHeight).toConst()
}

/** Strength of a storm: its surface with billows that stand out as far to all sides, and fibres at the anvil's rim. Twin: test/twins/storm.ts */
export function stormStrength(
  field: CloudField,
  layer: LayerNodes,
  weather: CloudWeather,
  billows: Billows,
  height: Float,
  level: Float
): StormStrength {
  const { coarse, fine, detail, inIce, softIce, reach } = stormBillows
  const all = iceAt(layer, height)
  const perRadius = weather.stormRadius.max(1).reciprocal().toConst() as Float
  const fromTower = weather.towerDistance.mul(perRadius).toConst() as Float
  const aside = smoothstep(...stormIce.aside, fromTower)
  const ice = all.mul(aside).toConst() as Float
  const amount = ice.mix(1, inIce).mul(layer.shapeAmount).toConst() as Float
  const stormDistance = frayedDistance(field, layer, weather, ice, height, level)
  const smooth = smoothStormStrength(layer, { ...weather, stormDistance }, height)
  // Bulges of the surface, not clouds beside it.
  const near = smooth.div(reach).add(1).clamp()
  const bulges = near.mul(billows.coarse).mul(coarse).add(billows.fine.mul(fine))
  return {
    strength: smooth.add(amount.mul(bulges)).toConst(),
    detail: amount.mul(layer.detailAmount).mul(detail).toConst(),
    edge: ice.mul(softIce).add(1).div(layer.perEdge).toConst(),
    // Fibres reach as far again in the thin rim as in its edge.
    density: stormDensity(
      all,
      ice,
      stormDistance.mul(2).sub(weather.stormDistance).mul(perRadius),
      fromTower
    )
  }
}
