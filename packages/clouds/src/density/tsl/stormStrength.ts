import type { CloudField } from '../CloudField'
import { stormBillows } from '../stormForm'
import type { Float } from '../../tsl-types'
import type { Billows } from './billows'
import { iceAt } from './heightForm'
import type { LayerNodes } from './layer'
import { stormBody } from './storm'
import { frayedDistance } from './stormFibres'
import type { CloudWeather } from './weather'

/** Strength of a storm at a place, as of `LayerSample`, in lengths of `stormBillows.unit`. */
export interface StormStrength {
  /** With coarse billows, and with fine ones, too [–]. */
  readonly body: Float
  readonly strength: Float
  /** Strength of detail, per deviation of its noise [–]. */
  readonly detail: Float
  /** Strength over which density rises at the edge [–]. */
  readonly edge: Float
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
  const ice = iceAt(layer, height)
  const amount = ice.mix(1, inIce).mul(layer.shapeAmount).toConst() as Float
  const stormDistance = frayedDistance(field, layer, weather, height, level)
  const smooth = smoothStormStrength(layer, { ...weather, stormDistance }, height)
  // Bulges of the surface, not clouds beside it.
  const near = smooth.div(reach).add(1).clamp(0, 1)
  const body = smooth.add(billows.coarse.mul(amount).mul(near).mul(coarse)).toConst() as Float
  return {
    body,
    strength: body.add(billows.fine.mul(amount).mul(fine)).toConst(),
    detail: amount.mul(layer.detailAmount).mul(detail).toConst(),
    edge: ice.mul(softIce).add(1).div(layer.perEdge).toConst()
  }
}
