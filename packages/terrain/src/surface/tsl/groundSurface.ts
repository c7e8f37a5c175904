import { float, mix, smoothstep, vec3 } from 'three/tsl'
import type { Float, Vec3 } from '../../tsl-types'
import { grainAt, type GrainPlace } from './grain'

/** Height of stones and tufts over the ground about them [m]. */
const GRAIN_HEIGHT = 0.035

// Reflectances, linear sRGB: rock and sand of the ASTER library's order, snow of a few days, grass of early summer.
const ROCK = [0.2, 0.178, 0.157]
const DARK_ROCK = [0.105, 0.098, 0.092]
const SCREE = [0.25, 0.232, 0.208]
const SAND = [0.4, 0.32, 0.215]
const DESERT = [0.39, 0.265, 0.15]
const GRASS = [0.073, 0.108, 0.031]
const STRAW = [0.2, 0.172, 0.078]
const FOREST = [0.02, 0.034, 0.013]
const SNOW = [0.83, 0.86, 0.9]
const SEA = [0.008, 0.02, 0.03]

const color = ([r, g, b]: number[]): Vec3 => vec3(r, g, b)

/** Surface of the ground at a place. */
export interface GroundSurface {
  /** Reflectance, linear sRGB. */
  readonly color: Vec3
  /** Roughness as of three's materials. */
  readonly roughness: Float
  /** Gradient of stones and tufts, to add to that of the ground [–]. */
  readonly grain: Vec3
}

/** A place of the ground, as pages have it. */
export interface GroundPlace extends GrainPlace {
  /** Height of the ground, that of the sea's floor under water [m]. */
  readonly height: Float
  /** Patchiness and climate, noise about 0. */
  readonly patch: Float
  readonly climate: Float
  /** Geodetic up, ECEF axes. */
  readonly up: Vec3
  /** Cosine of the ground's slope. */
  readonly cosSlope: Float
}

/**
 * Rock, scree, grass, forest, sand, snow and sea, by height, slope, latitude and noise.
 *
 * @param seaLevel - [m]
 */
export function groundSurface(place: GroundPlace, seaLevel: Float): GroundSurface {
  const { height, patch, climate, up, cosSlope } = place
  const grain = grainAt(place)
  const sinLatitude = up.z.abs().toConst('sinLatitude')
  const overSea = height.sub(seaLevel).toConst('overSea')

  // Snow lies above 4,900 m at the equator, 2,200 m in the Alps, and at sea level near the poles.
  const snowLine = float(4900).sub(sinLatitude.mul(sinLatitude).mul(5000)).toConst('snowLine')
  const overTrees = height.sub(snowLine).add(1100).add(patch.mul(350)).toConst('overTrees')
  const steepness = cosSlope
    .oneMinus()
    .add(patch.mul(0.05))
    .add(grain.value.mul(0.02))
    .toConst('steepness')

  const dryness = smoothstep(0.12, 0.4, sinLatitude)
    .mul(smoothstep(0.42, 0.62, sinLatitude).oneMinus())
    .mul(1.1)
    .sub(0.35)
    .add(climate.mul(1.4))
    .clamp(0, 1)
    .toConst('dryness')
  const tone = patch.mul(0.9).add(grain.value.mul(0.7)).toConst('tone')
  const rock = mix(color(DARK_ROCK), color(ROCK), tone.mul(1.1).add(0.55).clamp(0, 1))
  const meadow = mix(
    color(GRASS),
    color(STRAW),
    smoothstep(-0.3, 0.6, tone)
      .mul(0.55)
      .add(smoothstep(-900, 200, overTrees).mul(0.35))
  )
  const woods = smoothstep(-0.12, 0.1, patch.sub(dryness))
    .mul(smoothstep(-150, 50, overTrees).oneMinus())
    .mul(smoothstep(15, 60, overSea))
  const green = mix(meadow, color(FOREST), woods.mul(tone.mul(0.2).add(0.85).clamp(0, 1)))
  const soil = mix(green, color(DESERT).mul(tone.mul(0.35).add(1)), dryness)
  const alpine = mix(soil, color(SCREE).mul(tone.mul(0.4).add(1)), smoothstep(-50, 450, overTrees))
  const shore = mix(color(SAND), alpine, smoothstep(2, 9, overSea.add(patch.mul(4))))
  const bare = smoothstep(0.13, 0.24, steepness).toConst('bare')
  const land = mix(shore, rock, bare)
  const snow = smoothstep(-150, 250, height.sub(snowLine).add(patch.mul(420)))
    .mul(smoothstep(0.26, 0.42, steepness).oneMinus())
    .toConst('snow')
  const wet = smoothstep(0, 1.2, overSea.add(grain.value.mul(0.3))).toConst('wet')
  const isSea = overSea.lessThan(0).select(1, 0)
  const dry = mix(land, color(SNOW), snow).mul(wet.mul(0.45).add(0.55))
  const water = mix(color(SEA), color(SAND).mul(0.35), overSea.mul(0.35).exp().min(1))

  const rough = mix(float(0.95), float(0.75), snow)
  const height01 = mix(float(1), float(1.8), bare).mul(snow.mul(-0.8).add(1)).mul(isSea.oneMinus())
  return {
    color: mix(dry, water, isSea),
    roughness: mix(rough, float(0.22), isSea),
    grain: grain.gradient.mul(GRAIN_HEIGHT).mul(height01)
  }
}
