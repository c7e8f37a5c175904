/** Cells in a period, along each axis. */
export type Cells = readonly [number, number, number]

/** One sort of noise in a channel: `perlin` or `billow` of tsl/noise.ts. */
export interface NoiseTerm {
  readonly kind: 'perlin' | 'billow'
  readonly cells: Cells
  readonly weight: number
}

/** Map from the sum of a channel's terms, scaled to mean 0 and variance 1, to a number in [0, 1]. */
export type NoiseEncoding =
  /** ½ + 0.18 z, cut off. */
  | 'normal'
  /** Φ(z): every value as frequent as any other, so that a threshold of 1 − c covers the share c. */
  | 'uniform'

export interface NoiseChannel {
  readonly terms: readonly NoiseTerm[]
  readonly encoding: NoiseEncoding
  /** Shift of the look-up by Perlin noise of so many cells along each axis [periods]. */
  readonly warp?: { readonly cells: number; readonly amount: number }
}

/** Seeds of a channel's terms start here and count up; those of its warp follow. */
export const seedOf = (channel: number, term: number): number => 101 * (channel + 1) + 17 * term

/** Mean and standard deviation of the two sorts of noise, over all cell counts. */
export const noiseStatistics = { perlin: [0, 0.285], billow: [0.703, 0.18] } as const

/** Noise of ever finer cells, each of half the weight; with one number, the same along all axes. */
const octaves = (
  kind: NoiseTerm['kind'],
  cells: number | Cells,
  count: number,
  weight: number
): NoiseTerm[] => {
  const [x, y, z] = typeof cells === 'number' ? [cells, cells, cells] : cells
  return Array.from({ length: count }, (_, i) => ({
    kind,
    cells: [x << i, y << i, z << i],
    weight: weight / 2 ** i
  }))
}

/**
 * Shape noise, 128³ texels: Perlin–Worley (billows on a wavering whole), and finer billows.
 */
export const shapeChannels: readonly NoiseChannel[] = [
  {
    terms: [...octaves('billow', 4, 3, 1), ...octaves('perlin', 3, 3, 0.4)],
    encoding: 'normal'
  },
  { terms: octaves('billow', 14, 2, 1), encoding: 'normal' }
]

/** Detail noise, 32³ texels: its first channel. Curl fills the other three. */
export const detailChannel: NoiseChannel = {
  terms: octaves('billow', 3, 3, 1),
  encoding: 'normal'
}

/** Cells of the potential whose curl stirs the detail. */
export const CURL_CELLS = 4

/** Encoded curl is ½ + `CURL_SCALE` times the curl of the potential per cell. */
export const CURL_SCALE = 0.2

/**
 * Weather noise, 64³ texels, as many as 512²: cumulus, stratocumulus, cumulonimbus, cirrus.
 */
export const weatherChannels: readonly NoiseChannel[] = [
  {
    terms: [...octaves('billow', 9, 1, 1), ...octaves('perlin', 5, 2, 0.6)],
    encoding: 'uniform'
  },
  {
    terms: [...octaves('billow', 7, 1, 1), ...octaves('perlin', 6, 2, 0.25)],
    encoding: 'uniform'
  },
  {
    terms: [...octaves('billow', 5, 1, 1), ...octaves('perlin', 3, 4, 0.7)],
    encoding: 'uniform'
  },
  {
    // Sheets, which the ground cuts in streaks wherever they do not lie flat.
    terms: [...octaves('perlin', [2, 3, 9], 2, 1), ...octaves('perlin', [5, 5, 24], 1, 0.6)],
    encoding: 'uniform',
    warp: { cells: 3, amount: 0.1 }
  }
]
