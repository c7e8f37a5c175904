import {
  DRYNESS,
  MOIST,
  ROCK,
  SCREE,
  SHORE,
  SNOW,
  SNOW_LINE,
  TREES,
  WOODS
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

function smoothstep(start: number, end: number, value: number): number {
  const t = Math.min(Math.max((value - start) / (end - start), 0), 1)
  return t * t * (3 - 2 * t)
}

/** Shares of the ground's materials on open ground, without stones and blades. Twin of ../tsl/groundRules.ts and groundShares.ts. */
export function groundShares(place: PlaceOnCPU): SharesOnCPU {
  const { height, overSea, patch, climate, sinLatitude, sinNormal, cosSlope } = place
  const square = sinLatitude ** 2
  const sunny = (sinLatitude - sinNormal) * Math.sign(sinLatitude)
  const { equator, square: bySquare, fourth, dry, sunny: bySun } = SNOW_LINE
  const snowLine =
    equator - bySquare * square - fourth * square ** 2 + dry * climate + bySun * sunny
  const overSnow = height - snowLine
  const overTrees = overSnow + TREES.below + TREES.patch * patch
  const latitude = Math.abs(sinLatitude)
  const subtropical =
    smoothstep(...DRYNESS.begins, latitude) * (1 - smoothstep(...DRYNESS.ends, latitude))
  const dryness = Math.min(
    Math.max(DRYNESS.belts * subtropical + DRYNESS.least + DRYNESS.climate * climate, 0),
    1
  )
  const steepness = 1 - cosSlope + ROCK.patch * patch
  const lowland = 1 - smoothstep(...WOODS.lowland.over, overSea)
  const moisture =
    patch - dryness - WOODS.climate * climate - WOODS.open - WOODS.lowland.dry * lowland
  const layers = {
    snow:
      smoothstep(...SNOW.over, overSnow + SNOW.patch * patch) *
      (1 - smoothstep(...SNOW.steepness, steepness)),
    rock: smoothstep(...ROCK.steepness, steepness),
    sand: 1 - smoothstep(...SHORE.over, overSea + SHORE.patch * patch),
    scree: smoothstep(...SCREE, overTrees),
    desert: dryness,
    forest:
      smoothstep(-MOIST, 0, moisture) *
      (1 - smoothstep(...TREES.end, overTrees)) *
      smoothstep(...TREES.overSea, overSea)
  }
  const shares = { snow: 0, rock: 0, sand: 0, scree: 0, desert: 0, forest: 0, grass: 0 }
  let left = 1
  for (const name of Object.keys(layers) as (keyof typeof layers)[]) {
    shares[name] = left * layers[name]
    left -= shares[name]
  }
  return { ...shares, grass: left }
}
