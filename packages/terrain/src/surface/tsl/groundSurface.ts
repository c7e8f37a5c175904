import { float, mix, smoothstep, vec3 } from 'three/tsl'
import type { Float, Vec3 } from '../../tsl-types'
import { grainAt, type GrainPlace } from './grain'

/** Mean square of the slopes of stones. */
const GRAIN_VARIANCE = 0.3

/** Differences of height within a pixel, to its size on the ground, and at most [m]. */
const SPREAD = 0.12
const MOST_SPREAD = 450

/** Height by which snow lies higher where it is dry, per climate, and on slopes to the equator, per slope [m]. */
const DRY_SNOW = 500
const SUNNY_SNOW = 350

// Reflectances, linear sRGB: rock and sand of the ASTER library's order, snow of a few days, grass of early summer.
const ROCK = [0.19, 0.176, 0.158]
const DARK_ROCK = [0.105, 0.098, 0.092]
const SCREE = [0.238, 0.228, 0.21]
const SAND = [0.4, 0.32, 0.215]
const SEAWEED = [0.03, 0.026, 0.013]
const DESERT = [0.39, 0.265, 0.15]
const GRASS = [0.064, 0.086, 0.03]
const SOIL = [0.052, 0.04, 0.027]
const STRAW = [0.2, 0.172, 0.078]
const HEATH = [0.062, 0.05, 0.031]
const FOREST = [0.017, 0.028, 0.012]
const BROADLEAF = [0.033, 0.045, 0.015]
const SHRUB = [0.026, 0.034, 0.015]
const SNOW = [0.83, 0.86, 0.9]

const color = ([r, g, b]: number[]): Vec3 => vec3(r, g, b)

/** Surface of the ground at a place. */
export interface GroundSurface {
  /** Reflectance, linear sRGB. */
  readonly color: Vec3
  /** Strands of what floats, about 0. */
  readonly tangle: Float
  /** Light of stones and blades over their mean, for colours of pictures. */
  readonly detail: Float
  /** Longer side of the pixel on the ground, and differences of height within it [m]. */
  readonly footprint: Float
  readonly spread: Float
  /** Roughness as of three's materials. */
  readonly roughness: Float
  /** Gradient of stones, along the ground [–]. */
  readonly grain: Vec3
  /** Share of the sky's light that reaches between stones and blades. */
  readonly occlusion: Float
}

/** A place of the ground, as pages have it. */
export interface GroundPlace extends GrainPlace {
  /** Height of the ground, that of the sea's floor under water [m]. */
  readonly height: Float
  /** Patchiness and climate, noise about 0. */
  readonly patch: Float
  readonly climate: Float
  /** Unit vector to the north pole. */
  readonly pole: Vec3
  /** Cosine of the ground's slope. */
  readonly cosSlope: Float
}

/**
 * Rock, scree, grass, forest, sand and snow, by height, slope, latitude and noise.
 *
 * @param seaLevel - [m]
 */
export function groundSurface(place: GroundPlace, seaLevel: Float): GroundSurface {
  const { height, patch, climate, up, pole, cosSlope } = place
  const grain = grainAt(place)
  const { stone, blade, boulder, tuft, crown, brush } = grain
  const northing = up.dot(pole).toConst() as Float
  const sinLatitude = northing.abs().toConst('sinLatitude')
  const overSea = height.sub(seaLevel).toConst('overSea')

  // Snow lies above 5,200 m at the equator, 3,100 m in the Alps, 1,700 m at 60°, and at sea level near the poles.
  const square = sinLatitude.mul(sinLatitude).toConst('square')
  // Ground that falls towards the equator has a normal nearer to it than up is.
  const sunny = northing.sub(place.normal.dot(pole)).mul(northing.sign())
  const snowLine = float(5200)
    .sub(square.mul(square.mul(3600).add(2000)))
    .add(climate.mul(DRY_SNOW))
    .add(sunny.mul(SUNNY_SNOW))
    .toConst('snowLine')
  // A pixel that shows much ground shows its heights, too.
  const spread = grain.footprint.mul(SPREAD).min(MOST_SPREAD).toConst('spread')
  const overTrees = height.sub(snowLine).add(1100).add(patch.mul(350)).toConst('overTrees')
  const relief = stone.mul(0.6).add(boulder.mul(0.5)).add(crown.mul(0.6)).toConst('relief')
  const steepness = cosSlope
    .oneMinus()
    .add(patch.mul(0.05))
    .add(relief.mul(0.03))
    .toConst('steepness')

  const dryness = smoothstep(0.12, 0.4, sinLatitude)
    .mul(smoothstep(0.42, 0.62, sinLatitude).oneMinus())
    .mul(1.1)
    .sub(0.35)
    .add(climate.mul(1.4))
    .clamp(0, 1)
    .toConst('dryness')
  const tone = patch.mul(0.9).add(relief.mul(0.35)).toConst('tone')
  // Dark between stones, and between blades.
  const stony = stone.mul(0.45).add(1).toConst('stony')
  const light = blade.mul(1.05).add(tuft.mul(0.2)).toConst('light')
  const rock = mix(color(DARK_ROCK), color(ROCK), tone.mul(1.1).add(0.55).clamp(0, 1)).mul(stony)
  // Drier and fresher spots of metres, dry blades and soil of centimetres: the brightest and the darkest of the picture.
  const spots = boulder.mul(0.8).add(tuft.mul(0.5)).add(brush.mul(0.9)).toConst('spots')
  const straw = smoothstep(-0.45, 0.7, patch.mul(0.9).add(spots).add(sunny.mul(0.5)))
    .mul(0.6)
    .add(smoothstep(-900, 200, overTrees).mul(0.25))
    .max(smoothstep(0.36, 0.6, blade).mul(0.9))
  // Heather and dwarf shrubs lie in patches, more of them towards the tree line.
  const high = smoothstep(-900, 100, overTrees).toConst('high')
  const heath = smoothstep(-0.1, 0.35, spots.sub(patch.mul(0.9)).add(high.mul(0.3)).sub(0.15))
  const turf = mix(mix(color(GRASS), color(STRAW), straw), color(HEATH), heath.mul(0.8))
  const blades = turf.mul(light.add(brush.mul(0.35)).add(1).max(0.2))
  const grassland = mix(blades, color(SOIL), smoothstep(0.1, 0.32, blade.negate()).mul(0.85))
  // Shrubs stand in it, more of them towards the woods.
  const shrubs = smoothstep(0.22, 0.42, crown.add(patch.sub(dryness).mul(0.35)).sub(0.05)).toConst(
    'shrubs'
  )
  const meadow = mix(grassland, color(SHRUB), shrubs.mul(0.9))
  const woods = smoothstep(-0.2, 0, patch.sub(dryness).add(tuft.mul(0.12)).add(crown.mul(0.3)))
    .mul(smoothstep(-150, 50, overTrees).oneMinus())
    .mul(smoothstep(15, 60, overSea))
    .toConst('woods')
  const leaves = mix(
    color(FOREST),
    color(BROADLEAF),
    smoothstep(-0.5, 0.5, brush.mul(1.5).add(climate))
  )
  const floor = leaves.mul(light.mul(1.3).add(crown.mul(1.2)).add(1).max(0.3))
  const green = mix(meadow, floor, woods.mul(tone.mul(0.2).add(0.85).clamp(0, 1)))
  const soil = mix(green, color(DESERT).mul(tone.mul(0.35).add(1)).mul(stony), dryness)
  const scree = color(SCREE).mul(tone.mul(0.4).add(1)).mul(stony)
  // Stones come through grass where they are highest.
  const bareness = smoothstep(
    spread.add(50).negate(),
    spread.add(450),
    overTrees.add(relief.mul(260))
  ).toConst('bareness')
  const alpine = mix(soil, scree, bareness)
  const inland = smoothstep(2, 9, overSea.add(patch.mul(4)).add(relief)).toConst('inland')
  const sand = color(SAND).mul(stone.mul(0.14).add(1))
  // What high water left lies in strands, a metre above the sea.
  const tangle = blade.mul(0.7).add(boulder.mul(0.6)).toConst('tangle')
  const washed = overSea.add(boulder.mul(0.3)).add(patch.mul(0.5)).toConst()
  const strand = smoothstep(0.6, 0.9, washed).mul(smoothstep(1.1, 1.5, washed).oneMinus())
  const seaweed = strand.mul(smoothstep(0.02, 0.25, tangle)).mul(0.85)
  const shore = mix(mix(sand, color(SEAWEED), seaweed), alpine, inland)
  const bare = smoothstep(0.13, 0.24, steepness).toConst('bare')
  const land = mix(shore, rock, bare)
  const snow = smoothstep(
    spread.add(150).negate(),
    spread.add(250),
    height.sub(snowLine).add(patch.mul(420)).sub(relief.mul(160))
  )
    .mul(smoothstep(0.26, 0.42, steepness).oneMinus())
    .toConst('snow')
  const wet = smoothstep(0, 1.2, overSea.add(stone.mul(0.3))).toConst('wet')
  const dry = mix(land, color(SNOW), snow).mul(wet.mul(0.45).add(0.55))

  // Stones stand out of rock and scree, hardly out of grass, sand and snow.
  const stones = mix(bareness.mul(0.8).add(dryness.mul(0.15)).add(0.03), float(0.9), bare)
  const bump = mix(float(0.05), stones, inland.max(bare))
    .mul(snow.mul(-0.85).add(1))
    .toConst('bump')
  const rough = mix(mix(float(0.6), float(0.95), wet), float(0.75), snow)
  // Slopes that are smaller than a pixel roughen it: α² grows by twice their variance (Kaplanyan et al. 2016).
  const roughSquare = rough.mul(rough).toConst('roughSquare')
  const alpha = roughSquare.mul(roughSquare).add(
    bump
      .mul(bump)
      .mul(grain.lost)
      .mul(2 * GRAIN_VARIANCE)
  )
  const leafy = woods
    .max(shrubs)
    .mul(bare.max(bareness).max(dryness).max(snow).oneMinus())
    .mul(inland)
  const raised = mix(mix(bump.mul(0.55).max(0.13), float(0.7), leafy), float(0.06), snow).toConst(
    'raised'
  )
  const hollow = stone
    .add(boulder.mul(0.5))
    .min(0)
    .mul(bump)
    .add(blade.min(0).mul(0.5))
    .add(crown.min(0).mul(raised))
  return {
    tangle,
    detail: mix(light.mul(0.8), stone.mul(0.45), bareness.max(bare)).add(1),
    footprint: grain.footprint,
    spread,
    color: dry,
    roughness: alpha.sqrt().sqrt().min(1),
    grain: grain
      .gradient(bump, bump.mul(bareness.max(bare).mul(0.6)))
      .add(grain.canopySlope.mul(raised)),
    occlusion: hollow.mul(0.9).add(1).max(0.3)
  }
}
