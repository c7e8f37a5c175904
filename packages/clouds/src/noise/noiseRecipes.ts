/** Cells in a period, along each axis. */
export type Cells = readonly [number, number, number]

/** Displacement of a look-up by a curl of so many cells a period, which is without divergence. */
export interface Stir {
  readonly cells: number
  /** Standard deviation of the displacement along each axis [periods]. */
  readonly amount: number
}

/** One sort of noise in a channel: `perlin` or `billow` of tsl/gradientNoise.ts and tsl/billow.ts. */
export interface NoiseTerm {
  readonly kind: 'perlin' | 'billow'
  readonly cells: Cells
  readonly weight: number
  /** Displaces this term and those that follow in the channel. */
  readonly stir?: Stir
}

/** Map from the sum of a channel's terms, scaled to mean 0 and variance 1, to a number in [0, 1]. */
export type NoiseEncoding =
  /** ½ + `ENCODING_SCALE` z, cut off. */
  | 'normal'
  /** Φ(z): uniformly distributed, to 0.015, so that a threshold of 1 − c covers the share c. */
  | 'uniform'

export interface NoiseChannel {
  readonly terms: readonly NoiseTerm[]
  readonly encoding: NoiseEncoding
  /** Mean and standard deviation of the weighted terms' sum over the texture. */
  readonly statistics: readonly [mean: number, deviation: number]
  /** Shift of the look-up by Perlin noise of so many cells along each axis [periods]. */
  readonly warp?: { readonly cells: number; readonly amount: number }
}

/** Standard deviation of encoded noise: a value stands for z = (value − ½) / `ENCODING_SCALE`. */
export const ENCODING_SCALE = 0.18

/**
 * Seeds of a channel's terms start here and count up; those of its stirs and its warp follow. Further
 * apart than cells, which they are added to; with the first, even the 8 cells of the coarsest stir are
 * stirred about the same along each axis.
 */
export const seedOf = (channel: number, term: number): number => 1192 + 1024 * channel + 64 * term

/** Standard deviation of the two sorts of noise, and of a component of the curl, per cell. */
export const noiseDeviations = { perlin: 0.287, billow: 0.1727, curl: 0.7 } as const

/** Noise of ever finer cells; with one number, the same along all axes. */
const octaves = (
  kind: NoiseTerm['kind'],
  cells: number | Cells,
  count: number,
  weight: number,
  gain = 0.5
): NoiseTerm[] => {
  const [x, y, z] = typeof cells === 'number' ? [cells, cells, cells] : cells
  return Array.from({ length: count }, (_, i) => ({
    kind,
    cells: [x << i, y << i, z << i],
    weight: weight * gain ** i
  }))
}

/**
 * Displacement of coarse and of finer billows by curls of half as many cells, in cells of the billows. 0: round balls; greater:
 * torn threads, and flames for heads (*Cumulus*).
 */
const COARSE_STIR = 0.1
const FINE_STIR = 0.2

/** Two octaves of billows, each displaced by a curl of its own size on top of the one before. */
const stirredBillows = (cells: number, gain: number, amount: number): NoiseTerm[] =>
  octaves('billow', cells, 2, 1, gain).map(term => {
    const count = term.cells[0]
    return Object.assign(term, { stir: { cells: count >> 1, amount: amount / count } })
  })

/** Shape noise, 128³ texels, its first two channels: coarse and fine billows. Curl fills the rest. */
export const shapeChannels: readonly NoiseChannel[] = [
  {
    terms: stirredBillows(4, 2 ** -1.2, COARSE_STIR),
    encoding: 'normal',
    statistics: [0.691, 0.1814]
  },
  {
    terms: stirredBillows(16, 2 ** -0.4, FINE_STIR),
    encoding: 'normal',
    statistics: [0.8438, 0.2155]
  }
]

/** Last two channels of the shape noise: components x and y of a curl. */
export const shapeCurl = {
  /** Cells of the potentials. More: columns are folded into sheets instead of leaning (*Cumulus*). */
  cells: 3,
  /** Standard deviations of the components, per cell, over the texture. */
  deviations: [0.6748, 0.8275]
} as const

/** Detail noise, 64³ texels of one channel. */
export const detailChannel: NoiseChannel = {
  terms: stirredBillows(6, 2 ** -0.4, FINE_STIR),
  encoding: 'normal',
  statistics: [0.8449, 0.217]
}

/** Billows and Perlin noise in shares of their deviations, 2 : 1. */
const cauliflower = (cells: number, amplitude: number): NoiseTerm[] => [
  ...octaves('billow', cells, 1, (0.667 * amplitude) / noiseDeviations.billow),
  ...octaves('perlin', cells, 1, (0.333 * amplitude) / noiseDeviations.perlin)
]

/**
 * Weather noise, 64³ texels, as many as 512²: cumulus, stratocumulus, cumulonimbus, cirrus.
 */
export const weatherChannels: readonly NoiseChannel[] = [
  {
    terms: [0, 1, 2].flatMap(i => cauliflower(6 << i, 2 ** -i)),
    encoding: 'uniform',
    statistics: [3.243, 0.857]
  },
  {
    // Closed cells.
    terms: [...octaves('billow', 7, 2, 1, 0.35), ...octaves('perlin', 6, 2, 0.25)],
    encoding: 'uniform',
    statistics: [0.6457, 0.2044]
  },
  {
    terms: [...octaves('billow', 5, 1, 1), ...octaves('perlin', 3, 4, 0.7)],
    encoding: 'uniform',
    statistics: [0.4781, 0.2843]
  },
  {
    // Layers, which the ground cuts in streaks wherever they do not lie flat.
    terms: [...octaves('perlin', [2, 3, 9], 2, 1), ...octaves('perlin', [5, 5, 24], 1, 0.6)],
    encoding: 'uniform',
    statistics: [-0.0005, 0.3727],
    warp: { cells: 3, amount: 0.1 }
  }
]

/** Index of a texture's first channel among all channels: sets the seeds. */
export const FIRST_CHANNEL = { shape: 0, detail: 4, weather: 5 } as const
