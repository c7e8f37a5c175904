import { float, smoothstep, vec2 } from 'three/tsl'
import type { Float, Vec2, Vec3 } from '../../tsl-types'
import {
  DRY_BEGINS,
  DRY_BELTS,
  DRY_CLIMATE,
  DRY_ENDS,
  DRY_SNOW,
  DRY_WOODS,
  LEAST_DRYNESS,
  LOWLAND,
  LOWLAND_DRYNESS,
  MOIST,
  OPEN,
  ROCK_PATCH,
  ROCK_STEEPNESS,
  SCREE,
  SLOPES,
  SLOPE_WOODS,
  SHORE,
  SHORE_PATCH,
  SNOW_BY_FOURTH,
  SNOW_BY_SQUARE,
  SNOW_LINE,
  SNOW_OVER,
  SNOW_PATCH,
  SNOW_STEEPNESS,
  SUNNY_SNOW,
  TREES_BELOW,
  TREES_END,
  TREES_OVER_SEA,
  TREES_PATCH
} from '../groundConstants'
import type { OfKinds } from '../maps/groundKinds'
import type { Grain, GrainPlace } from './grain'

/** Differences of height within a pixel, to its size on the ground, and at most [m]. */
const SPREAD = 0.12
const MOST_SPREAD = 450

/**
 * Deviation of patches that a pixel of {@link PATCHES_GONE} does not show: a share of it is woods then. It goes by the power 3/4 of its size.
 * By the square root, as the octaves of patches do, of 4,000 m: woods from 400 km are camouflage (*Terrain*, still 400km).
 */
const PATCH_DEVIATION = 0.42
const PATCHES_GONE = 800

/** Height by which snow lies lower in hollows that see nothing of the sky [m], and slope by which more soil holds there. */
const HOLLOW_SNOW = 700
const HOLLOW_SOIL = 0.15

/** A place of the ground, as pages have it. */
export interface GroundPlace extends GrainPlace {
  /** Height of the ground, that of the sea's floor under water [m]. */
  readonly height: Float
  /** Patchiness and climate, noise about 0. */
  readonly patch: Float
  readonly climate: Float
  /** Unit vector to the north pole. */
  readonly pole: Vec3
  /** See `groundZone`. */
  readonly zone: Vec2
  /** Cosine of the ground's slope. */
  readonly cosSlope: Float
  /** Share of the sky that the ground about hides of what its slope leaves: more in hollows. */
  readonly hollow: Float
}

/** Layers from the top down, each as a share of what those before it leave: snow, rock, no sand of the shore, scree, desert, woods; the rest is grass. */
export interface GroundLayers {
  readonly snow: Float
  readonly bare: Float
  readonly inland: Float
  readonly bareness: Float
  readonly dryness: Float
  readonly woods: Float
}

/** Reflectances of procedural materials, linear sRGB; desert is sand inland. */
export type GroundColors = OfKinds<Vec3> & { readonly desert: Vec3 }

/** Ground by its rules: layers, and what they were found from. */
export interface GroundRules {
  readonly layers: GroundLayers
  /** Height of stones and crowns about 0. */
  readonly relief: Float
  /** Differences of height within a pixel [m]. */
  readonly spread: Float
}

/** Climate of a place, for which no stone counts. */
export interface GroundClimate {
  /** Height over the sea, and over the snow line and the tree line [m]. */
  readonly overSea: Float
  readonly overSnow: Float
  readonly overTrees: Float
  /** Slope towards the equator. */
  readonly sunny: Float
  readonly dryness: Float
  /** Share of a plain just above the sea. */
  readonly lowland: Float
}

/**
 * Ground by latitude, found at vertices: height of the snow line (x) [m] and dryness (y) where it is neither wet nor dry country.
 *
 * @param northing - Sine of the latitude.
 */
export function groundZone(northing: Float): Vec2 {
  const sinLatitude = northing.abs().toConst()
  const square = sinLatitude.mul(sinLatitude).toConst()
  const line = float(SNOW_LINE).sub(square.mul(square.mul(SNOW_BY_FOURTH).add(SNOW_BY_SQUARE)))
  const dryness = smoothstep(...DRY_BEGINS, sinLatitude)
    .mul(smoothstep(...DRY_ENDS, sinLatitude).oneMinus())
    .mul(DRY_BELTS)
    .add(LEAST_DRYNESS)
  return vec2(line, dryness)
}

/** @param seaLevel - Surface of the sea above the ellipsoid [m]. */
export function groundClimate(place: GroundPlace, seaLevel: Float): GroundClimate {
  const { height, patch, climate, up, pole, zone } = place
  const northing = up.dot(pole).toConst() as Float
  const overSea = height.sub(seaLevel).toConst() as Float
  // Ground that falls towards the equator has a normal nearer to it than up is.
  const sunny = northing.sub(place.normal.dot(pole)).mul(northing.sign()) as unknown as Float
  const snowLine = zone.x.add(climate.mul(DRY_SNOW)).add(sunny.mul(SUNNY_SNOW))
  const overSnow = height.sub(snowLine).toConst() as Float
  const overTrees = overSnow.add(TREES_BELOW).add(patch.mul(TREES_PATCH)).toConst() as Float
  const dryness = zone.y.add(climate.mul(DRY_CLIMATE)).clamp(0, 1).toConst() as Float
  const lowland = smoothstep(...LOWLAND, overSea)
    .oneMinus()
    .toConst()
  return { overSea, overSnow, overTrees, sunny, dryness, lowland }
}

/** Layers by height, slope, curvature, latitude and noise. */
export function groundRules(
  place: GroundPlace,
  grain: Grain,
  { overSea, overSnow, overTrees, dryness, lowland }: GroundClimate
): GroundRules {
  const { patch, climate, cosSlope, hollow } = place
  const { stone, boulder, tuft, crown } = grain
  // A pixel that shows much ground shows its heights, too.
  const spread = grain.footprint.mul(SPREAD).min(MOST_SPREAD).toConst()
  const blurred = ([from, to]: readonly [number, number], height: Float): Float =>
    smoothstep(spread.negate().add(from), spread.add(to), height)
  const relief = stone.mul(0.6).add(boulder.mul(0.5)).add(crown.mul(0.6)).toConst()
  const steepness = cosSlope
    .oneMinus()
    .add(patch.mul(ROCK_PATCH))
    .add(relief.mul(0.03))
    .sub(hollow.mul(HOLLOW_SOIL))
    .toConst()

  const gone = grain.footprint.div(PATCHES_GONE).min(1).toConst()
  const lost = gone.mul(gone.sqrt()).sqrt().mul(PATCH_DEVIATION).toConst()
  const moisture = patch
    .sub(dryness)
    .sub(climate.mul(DRY_WOODS))
    .sub(OPEN)
    .sub(lowland.mul(LOWLAND_DRYNESS))
    .add(smoothstep(...SLOPES, cosSlope.oneMinus()).mul(SLOPE_WOODS))
  const woods = smoothstep(
    lost.add(MOIST).negate(),
    lost,
    moisture.add(tuft.mul(0.12)).add(crown.mul(0.3))
  )
    .mul(smoothstep(...TREES_END, overTrees).oneMinus())
    // As with beaches: a pixel that shows much ground shows what lies behind the shore.
    .mul(smoothstep(...TREES_OVER_SEA, overSea.add(spread)))
    .toConst()
  // Stones come through grass where they are highest.
  const bareness = blurred(SCREE, overTrees.add(relief.mul(260))).toConst()
  // A pixel as large as a beach is mostly of what lies behind it.
  const inland = smoothstep(
    ...SHORE,
    overSea.add(patch.mul(SHORE_PATCH)).add(relief).add(spread)
  ).toConst()
  const bare = smoothstep(...ROCK_STEEPNESS, steepness).toConst()
  const snow = blurred(
    SNOW_OVER,
    overSnow.add(patch.mul(SNOW_PATCH)).add(hollow.mul(HOLLOW_SNOW)).sub(relief.mul(160))
  )
    .mul(smoothstep(...SNOW_STEEPNESS, steepness).oneMinus())
    .toConst()
  const layers = { snow, bare, inland, bareness, dryness, woods }
  return { layers, relief, spread }
}
