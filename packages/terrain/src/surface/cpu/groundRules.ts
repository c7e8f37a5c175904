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
  const snowLine = 5200 - 2000 * square - 3600 * square ** 2 + 500 * climate + 350 * sunny
  const overSnow = height - snowLine
  const overTrees = overSnow + 1100 + 350 * patch
  const subtropical =
    smoothstep(0.12, 0.4, Math.abs(sinLatitude)) *
    (1 - smoothstep(0.42, 0.62, Math.abs(sinLatitude)))
  const dryness = Math.min(Math.max(1.1 * subtropical - 0.35 + 1.4 * climate, 0), 1)
  const steepness = 1 - cosSlope + 0.05 * patch
  const lowland = 1 - smoothstep(60, 420, overSea)
  const moisture = patch - dryness - 1.4 * climate - 0.15 - 0.4 * lowland
  const layers = {
    snow: smoothstep(-150, 250, overSnow + 420 * patch) * (1 - smoothstep(0.26, 0.42, steepness)),
    rock: smoothstep(0.13, 0.24, steepness),
    sand: 1 - smoothstep(2, 9, overSea + 4 * patch),
    scree: smoothstep(-50, 450, overTrees),
    desert: dryness,
    forest:
      smoothstep(-0.2, 0, moisture) *
      (1 - smoothstep(-150, 50, overTrees)) *
      smoothstep(15, 60, overSea)
  }
  const shares = { snow: 0, rock: 0, sand: 0, scree: 0, desert: 0, forest: 0, grass: 0 }
  let left = 1
  for (const name of Object.keys(layers) as (keyof typeof layers)[]) {
    shares[name] = left * layers[name]
    left -= shares[name]
  }
  return { ...shares, grass: left }
}
