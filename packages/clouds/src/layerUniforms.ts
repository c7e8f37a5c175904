import type { CloudLayerParameters } from './CloudLayer'

/** Vectors that a layer takes in the uniform array of all layers. */
export const LAYER_STRIDE = 11

/** Period of the weather texture for a layer 1200 m thick [m]. */
const WEATHER_PERIOD = 15_000

/** Period of the shape texture for such a layer [m]. */
const SHAPE_PERIOD = 2600

/** Period of the same texture where it sets the mean coverage of regions [m]. */
export const REGION_PERIOD = 410_000

/**
 * How far the regions shift the look-up of the weather [m]: enough for its repetitions to fall out of
 * step, over distances that do not distort it.
 */
export const WEATHER_WARP = 8000

/**
 * The weather is looked up twice, in lattices without a common period: what one repeats, the other
 * does not. Period of the second in those of the first, and its weight.
 */
export const WEATHER_AGAIN = { period: Math.sqrt(3), weight: 0.75 } as const

/** How far the second look-up of the weather shifts those of shape and detail [m]. */
export const SHAPE_WARP = 600

/** Period of the detail texture [m]. */
export const DETAIL_PERIOD = 330

/** How far turbulence moves the look-up of the detail, in periods for a curl of 1. */
export const CURL_AMOUNT = 0.25

/** Period of the turbulence, in periods of the detail. */
export const CURL_PERIOD = 5

/**
 * Periods of a layer's weather and shape noise [m]: tall clouds are broad and have large heads. In
 * powers of 2, or else every change of an altitude would move the noise, which is anchored at the
 * planet's centre.
 */
export function layerPeriods({ baseAltitude, topAltitude }: CloudLayerParameters): {
  weather: number
  shape: number
} {
  const octaves = Math.log2((topAltitude - baseAltitude) / 1200)
  const scale = (share: number): number =>
    2 ** Math.min(Math.max(Math.round(share * octaves), -2), 2)
  return { weather: WEATHER_PERIOD * scale(0.7), shape: SHAPE_PERIOD * scale(0.5) }
}

/**
 * Factors of the weather's channels, each uniform in [−½, ½] about its mean: the sum over both look-ups
 * has variance 1. All zero when all weights are.
 */
export function standardWeights(weights: readonly number[]): [number, number, number, number] {
  const norm =
    (Math.hypot(...weights) || 1) * Math.hypot(1, WEATHER_AGAIN.weight) * Math.sqrt(1 / 12)
  const [a, b, c, d] = weights.map(weight => weight / norm)
  return [a, b, c, d]
}

/** Constants of the density function, found by looking at its pictures. */
export const densityShape = {
  /** Change of weather noise over which a layer fills from edge to middle. */
  edgeWidth: 0.5,
  /** Fill where noise puts the edge on average, per shape amount: it makes coverage what it says. */
  meanEdge: 0.44,
  /** Added to the fill at full coverage, taken at none. */
  excess: 0.6,
  /** How far the regions' coverage departs from the layer's. */
  regionContrast: 0.5,
  /** The shape carves at least this part of its amount: what is less full is empty for sure. */
  leastCarving: 0.15,
  /** Most that detail takes away. */
  erosion: 0.22,
  /** Density per fullness left, of smooth layers and of carved ones: how sharp edges are. */
  smoothSharpness: 1.5,
  carvedSharpness: 6,
  /** Mean density of a cloudy column over the densest. */
  farFill: 0.6
} as const
