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
  /** Bows in rain under clouds. */
  rainbow: boolean
  /** Wet ground and snow cover. */
  wetGround: boolean
  moon: boolean
  /** Moonlight on the land. */
  moonlight: boolean
  stars: boolean
  milkyWay: boolean
  airglow: boolean
  flare: boolean
  trees: boolean
  village: boolean
  /** Lamps and lit windows of the village, by night. */
  lamps: boolean
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
  style: AirStyle,
  { shafts, node, sky: [galaxy, starlight, glow], luna, flare, exposure }: FactorTargets
): void {
  const { twilightSaturation, ambient, earthshine, purkinjeShift } = state
  const haze = Number(state.haze) * state.hazeStrength
  const shaftStrength = Number(state.shafts) * state.shaftStrength
  const starsStrength = Number(state.stars) * state.starlight
  const galaxyStrength = Number(state.milkyWay) * state.starlight
  const glowStrength = Number(state.airglow) * state.airglowStrength
  const strength = Number(state.moon)
  // #region factors
  // #shown import { airStyle } from '@welkin/atmosphere'
  // #shown const [haze, twilightSaturation, ambient, shaftStrength] = [0.7, 1.3, 1.1, 0.8]
  // #shown const [starsStrength, galaxyStrength, glowStrength] = [2, 2, 2]
  // #shown const [strength, earthshine, purkinjeShift] = [1, 3, 1]
  // #shown const style = airStyle()
  // #shown atmosphere.add(style)
  style.set({ haze, twilightSaturation })
  node.ambient = ambient
  shafts.strength = shaftStrength
  starlight.intensity = starsStrength
  galaxy.intensity = galaxyStrength
  glow.intensity = glowStrength
  luna.set({ strength, earthshine })
  exposure.purkinjeShift = purkinjeShift // nights as eyes see them
  // #endregion
  flare.set(state.flare ? FLARE : NO_FLARE)
}
