import { MathUtils } from 'three'
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

/** A place of the ground, for float64. */
export interface PlaceOnCPU {
  /** Height of the ground over the ellipsoid, and over the sea [m]. */
  readonly height: number
  readonly overSea: number
  /** Patchiness and climate, noise about 0. */
  readonly patch: number
  readonly climate: number
  /** Sines of the latitude and of that of the ground's normal. */
  readonly sinLatitude: number
  readonly sinNormal: number
  /** Cosine of the ground's slope. */
  readonly cosSlope: number
}

/** Shares of materials with a sum of 1, desert being sand inland. */
export type SharesOnCPU = OfKinds<number> & { readonly desert: number }

const { smoothstep } = MathUtils

/** Shares of the ground's materials on open ground, without stones and blades. Twin of ../tsl/groundRules.ts and groundShares.ts. */
export function groundShares(place: PlaceOnCPU): SharesOnCPU {
  const { height, overSea, patch, climate, sinLatitude, sinNormal, cosSlope } = place
  const square = sinLatitude ** 2
  const sunny = (sinLatitude - sinNormal) * Math.sign(sinLatitude)
  const snowLine =
    SNOW_LINE -
    SNOW_BY_SQUARE * square -
    SNOW_BY_FOURTH * square ** 2 +
    DRY_SNOW * climate +
    SUNNY_SNOW * sunny
  const overSnow = height - snowLine
  const overTrees = overSnow + TREES_BELOW + TREES_PATCH * patch
  const latitude = Math.abs(sinLatitude)
  const subtropical = smoothstep(latitude, ...DRY_BEGINS) * (1 - smoothstep(latitude, ...DRY_ENDS))
  const dryness = Math.min(
    Math.max(DRY_BELTS * subtropical + LEAST_DRYNESS + DRY_CLIMATE * climate, 0),
    1
  )
  const steepness = 1 - cosSlope + ROCK_PATCH * patch
  const lowland = 1 - smoothstep(overSea, ...LOWLAND)
  const wooded = SLOPE_WOODS * smoothstep(1 - cosSlope, ...SLOPES)
  const moisture = patch + wooded - dryness - DRY_WOODS * climate - OPEN - LOWLAND_DRYNESS * lowland
  const layers = {
    snow:
      smoothstep(overSnow + SNOW_PATCH * patch, ...SNOW_OVER) *
      (1 - smoothstep(steepness, ...SNOW_STEEPNESS)),
    rock: smoothstep(steepness, ...ROCK_STEEPNESS),
    sand: 1 - smoothstep(overSea + SHORE_PATCH * patch, ...SHORE),
    scree: smoothstep(overTrees, ...SCREE),
    desert: dryness,
    forest:
      smoothstep(moisture, -MOIST, 0) *
      (1 - smoothstep(overTrees, ...TREES_END)) *
      smoothstep(overSea, ...TREES_OVER_SEA)
  }
  const shares = { snow: 0, rock: 0, sand: 0, scree: 0, desert: 0, forest: 0, grass: 0 }
  let left = 1
  for (const name of Object.keys(layers) as (keyof typeof layers)[]) {
    shares[name] = left * layers[name]
    left -= shares[name]
  }
  return { ...shares, grass: left }
}
