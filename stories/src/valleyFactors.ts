import type {
  Airglow,
  AirStyle,
  AutoExposureNode,
  LightShafts,
  MilkyWay,
  Moon,
  Stars
} from '@welkin/atmosphere'
import type { CloudsNode } from '@welkin/clouds'

/** Artistic factors of the valley, 1 where it is as physics has it. */
export interface ValleyFactors {
  haze: number
  twilightSaturation: number
  shaftStrength: number
  starlight: number
  airglow: number
  earthshine: number
  ambient: number
  purkinjeShift: number
}

/** Parts of the valley that factors act on. */
export interface FactorTargets {
  readonly shafts: LightShafts
  readonly node: CloudsNode
  readonly sky: readonly [MilkyWay, Stars, Airglow]
  readonly luna: Moon
  readonly exposure: AutoExposureNode
}

/**
 * Sets the valley's factors.
 *
 * @param on - 1 where shafts or the night sky are shown, else 0.
 */
export function applyFactors(
  factors: ValleyFactors,
  air: AirStyle,
  { shafts, node, sky: [galaxy, starlight, glow], luna, exposure }: FactorTargets,
  on: { shafts: number; nightSky: number }
): void {
  const { haze, twilightSaturation, ambient } = factors
  // #region factors
  air.set({ haze, twilightSaturation }) // atmosphere.add(airStyle())
  node.ambient = ambient
  shafts.strength = on.shafts * factors.shaftStrength
  galaxy.intensity = starlight.intensity = on.nightSky * factors.starlight
  glow.intensity = on.nightSky * factors.airglow
  luna.set({ strength: on.nightSky, earthshine: factors.earthshine })
  exposure.purkinjeShift = factors.purkinjeShift // nights as eyes see them
  // #endregion
}
