import type {
  Airglow,
  AirStyle,
  AutoExposureNode,
  LightShafts,
  MilkyWay,
  Moon,
  Stars,
  SunFlare
} from '@welkin/atmosphere'
import type { CloudsNode } from '@welkin/clouds'

/** Artistic factors of the valley, 1 where it is as physics has it. */
export interface ValleyFactors {
  hazeStrength: number
  twilightSaturation: number
  shaftStrength: number
  starlight: number
  airglowStrength: number
  earthshine: number
  ambient: number
  purkinjeShift: number
}

/** Features of the valley that can be switched on and off while it runs. */
export interface ValleyFeatures {
  clouds: boolean
  /** Shadows of clouds on the ground, in the air and on the light of the sky. */
  cloudShadows: boolean
  /** Shadows of things in sunlight and moonlight. */
  shadows: boolean
  shafts: boolean
  haze: boolean
  mist: boolean
  precipitation: boolean
  moon: boolean
  stars: boolean
  airglow: boolean
  flare: boolean
  trees: boolean
  village: boolean
  water: boolean
  /** Sky and clouds in the lake beside what is in the picture. */
  environment: boolean
  autoExposure: boolean
}

/** Parts of the valley that factors and switches act on. */
export interface FactorTargets {
  readonly shafts: LightShafts
  readonly node: CloudsNode
  readonly sky: readonly [MilkyWay, Stars, Airglow]
  readonly luna: Moon
  readonly flare: SunFlare
  readonly exposure: AutoExposureNode
}

/** Strengths of the sun's halo. */
const FLARE = { innerStrength: 0.006, outerStrength: 0.004 }
const NO_FLARE = { innerStrength: 0, outerStrength: 0 }

/** Sets the valley's factors; what is switched off has none. */
export function applyFactors(
  state: ValleyFactors & ValleyFeatures,
  air: AirStyle,
  { shafts, node, sky: [galaxy, starlight, glow], luna, flare, exposure }: FactorTargets
): void {
  const { twilightSaturation, ambient } = state
  const [hasHaze, hasShafts] = [Number(state.haze), Number(state.shafts)]
  const [hasStars, hasGlow, strength] = [state.stars, state.airglow, state.moon].map(Number)
  // #region factors
  air.set({ haze: hasHaze * state.hazeStrength, twilightSaturation }) // atmosphere.add(airStyle())
  node.ambient = ambient
  shafts.strength = hasShafts * state.shaftStrength
  galaxy.intensity = starlight.intensity = hasStars * state.starlight
  glow.intensity = hasGlow * state.airglowStrength
  luna.set({ strength, earthshine: state.earthshine })
  flare.set(state.flare ? FLARE : NO_FLARE)
  exposure.purkinjeShift = state.purkinjeShift // nights as eyes see them
  // #endregion
}
