import { fractalNoise } from './noise.ts'

type Colour = readonly [number, number, number]

// sRGB, 0–255.
const DEEP_FOREST: Colour = [50, 68, 40]
const LIGHT_FOREST: Colour = [90, 104, 60]
const PASTURE: Colour = [112, 120, 70]
const FIELD: Colour = [142, 132, 90]
const ROCK: Colour = [122, 113, 99]
/** Colour of the globe around the tileset: see `surfaceNodes` in src/globe/earthSurface.ts. */
const SURROUNDINGS: Colour = [88, 117, 52]

function mix(a: Colour, b: Colour, t: number): Colour {
  return [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t]
}

function smoothstep(low: number, high: number, x: number): number {
  const t = Math.min(Math.max((x - low) / (high - low), 0), 1)
  return t * t * (3 - 2 * t)
}

/**
 * Likelihood of woods at a point, in [0, 1]: they grow on slopes and heights, and in patches elsewhere.
 *
 * @param height - Above sea level [m].
 * @param slope - Rise over run.
 * @param row - Grid row, fractions allowed; with `column`, places the patches.
 */
export function woodland(height: number, slope: number, row: number, column: number): number {
  const patches = fractalNoise(row / 5, column / 5, 5)
  return smoothstep(-0.06, 0.06, slope + (height - 420) / 2500 + (patches - 0.53) * 0.6 - 0.06)
}

/**
 * Colour of the ground: woods, pastures and fields in the flat valleys, rock where it is steep. Arguments as above.
 *
 * @param outside - 0 on measured ground to 1 at the end of the apron, where it meets the globe.
 * @returns sRGB, 0–255.
 */
export function groundColour(
  height: number,
  slope: number,
  row: number,
  column: number,
  outside: number
): Colour {
  const patches = fractalNoise(row / 5, column / 5, 5)
  const crowns = fractalNoise(row * 2, column * 2, 2)
  const forest = mix(DEEP_FOREST, LIGHT_FOREST, smoothstep(0.2, 0.8, patches * 0.5 + crowns * 0.5))
  const open = mix(PASTURE, FIELD, smoothstep(0.5, 0.62, fractalNoise(row / 3 + 91, column / 3, 3)))
  const ground = mix(open, forest, woodland(height, slope, row, column))
  const rocky = mix(ground, ROCK, smoothstep(0.6, 0.9, slope + (crowns - 0.5) * 0.3))
  return mix(
    rocky,
    SURROUNDINGS,
    smoothstep(0.05, 0.75, outside + (patches - 0.5) * 0.5 * smoothstep(0, 0.1, outside))
  )
}
