import type { CloudLayerParameters } from './CloudLayer'
import { erosionForm, strengthForm } from '../density/formConstants'

/** Vectors that a layer takes in the uniform array of all layers. */
export const LAYER_STRIDE = 12

/**
 * Period of the weather texture for a layer 1200 m thick [m]. Greater: larger clouds, farther apart
 * (*Cumulus*).
 */
const WEATHER_PERIOD = 15_000

/** Period of the shape texture for such a layer [m]. Greater: broader billows, smoother clouds (*Cumulus*). */
const SHAPE_PERIOD = 2600

/**
 * Period of the weather texture where it holds the systems of whole regions [m]. Greater: broader fronts
 * and clear zones (*World clouds from afar*, without its map).
 */
export const REGION_PERIOD = 2_300_000

/**
 * Shift of the weather's look-ups by the regions [periods of the weather]: repetitions fall out of step.
 * 0: the same clouds every 15 km, in rows (*World clouds*, without its map).
 */
export const WEATHER_WARP = 0.5

/**
 * The weather is looked up a second time for the fields that clouds gather in, in a lattice without a
 * common period with the first. Its period in those of the first.
 */
export const FIELD_PERIOD = 3 * Math.sqrt(6)

/**
 * Shifts of the look-ups of shape and detail by both of the weather [periods of the shape]. 0: the same
 * billows on many clouds (*Cockpit*); much greater: billows are drawn out.
 */
export const FIELD_WARP = 1.1
export const CLOUD_WARP = 0.3

/**
 * Shift of a world map's look-up by the fields, for a map of so many texels around the planet: half a
 * texel to either side, as far as fields are large enough for that [rad]. 0: the map's texels show as
 * squares near the ground (*World clouds*).
 */
export const mapShift = (width: number): number => Math.min((2 * Math.PI) / width, 0.003)

/**
 * Waves around the planet: of each axis in the next two [rad], and how far they shift the regions, in
 * periods. Without that shift regions repeat every 2,300 km (*World clouds from afar*, without its map).
 */
export const NEXT_WAVES = 3.1
export const LAST_WAVES = 1.7
export const PLANET_WARP = 0.22

/**
 * Weights of the scales that the weather is the sum of, with that of single clouds 1: fields of tens of
 * kilometres, of the layer's own weather and of large cells; regions; the planet. A greater one
 * gathers clouds more at its scale, with more clear sky between: *Cockpit* for fields, *World clouds from
 * afar* without its map for the others.
 */
export const FIELD_WEIGHT = 0.6
const CELL_WEIGHT = 0.5
const REGION_WEIGHT = 0.65
const PLANET_WEIGHT = 0.4

/** Share of finer cells in the regions. 0: their edges have no finer structure (*World clouds from afar*, without its map). */
export const REGION_CELLS = 0.6

/** Length over width of cirrus' noise [–]. Smaller: blobs instead of fibres (*Cirrus*). */
const CIRRUS_STRETCH = 9

/**
 * Thickness of layers that begin to have anvils, and of those that have large ones [m]. Smaller:
 * thinner layers get anvils (*Storm*).
 */
const LEAST_ANVIL = 4000
const LARGE_ANVIL = 8000

/** Period of the detail texture [m]. Greater: coarser wisps at edges (*Inside a cloud*). */
export const DETAIL_PERIOD = 330

/**
 * Shift of the detail's look-up by turbulence, for a curl of 1 [periods]. 0: edges of round crumbs instead
 * of wisps (*Inside a cloud*).
 */
export const CURL_AMOUNT = 0.25

/** Period of the turbulence, in periods of the detail. Smaller: finer wisps (*Inside a cloud*). */
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
  return { weather: WEATHER_PERIOD * scale(0.45), shape: SHAPE_PERIOD * scale(0.5) }
}

/** Weights of the weather's scales in a layer. */
export interface WeatherScales {
  /** Factors of the channels where they are single clouds. */
  readonly clouds: readonly [number, number, number, number]
  /** Factor of the same sum of channels where they are fields, and of the large cells there. */
  readonly fields: number
  readonly cells: number
  readonly regions: number
  readonly planet: number
  /** Shares of the variance. */
  readonly cloudVariance: number
  readonly fieldVariance: number
}

/**
 * Factors of the weather's channels, each uniform in [−½, ½] about its mean, and of the planet's waves,
 * of variance 1: the sum of all has variance 1. No clouds count when all weights are 0.
 *
 * @param hasMap - Whether a map has what is larger than fields.
 */
export function weatherScales(weights: readonly number[], hasMap: boolean): WeatherScales {
  const size = Math.hypot(...weights) || 1
  const unit = weights.map(weight => weight / size)
  // Large cells are the third channel.
  const fieldVariance =
    FIELD_WEIGHT ** 2 + CELL_WEIGHT ** 2 + 2 * FIELD_WEIGHT * CELL_WEIGHT * (unit[2] ?? 0)
  const large = hasMap ? 0 : 1
  const variance = 1 + fieldVariance + large * (REGION_WEIGHT ** 2 + PLANET_WEIGHT ** 2)
  const factor = Math.sqrt(12 / variance)
  const [a, b, c, d] = unit.map(weight => weight * factor)
  return {
    clouds: [a, b, c, d],
    fields: FIELD_WEIGHT,
    cells: CELL_WEIGHT * factor,
    regions: (large * REGION_WEIGHT * factor) / Math.hypot(1, REGION_CELLS),
    planet: (large * PLANET_WEIGHT) / Math.sqrt(variance),
    cloudVariance: 1 / variance,
    fieldVariance: fieldVariance / variance
  }
}

const shareOf = (weights: readonly number[], index: number): number =>
  weights[index] ** 2 / (weights.reduce((sum, weight) => sum + weight ** 2, 0) || 1)

/** Forms that a layer's kind of weather gives its clouds. */
export function layerForms({
  weatherWeights,
  shapeAmount,
  baseAltitude,
  topAltitude
}: CloudLayerParameters): {
  /** Length over width of the noise that erodes them. */
  stretch: number
  /** Share of cirrus in its weather, in [0, 1]. */
  fibrous: number
  /** Slope of column strength against the weather [–]. */
  steepness: number
  /** Slope of density against what erosion leaves of the dimensional profile [–]. */
  sharpness: number
  /** Levels of detail by which its weather is coarser than others. */
  coarseness: number
  /** Share of anvils that its towers spread into at their tops, in [0, 1]. */
  anvil: number
} {
  const fibrous = shareOf(weatherWeights, 3)
  const mix = (from: number, to: number, share: number): number => from + (to - from) * share
  const eroded = shapeAmount ** 2 * (1 - fibrous)
  const towers = shareOf(weatherWeights, 2)
  const tall = (topAltitude - baseAltitude - LEAST_ANVIL) / (LARGE_ANVIL - LEAST_ANVIL)
  return {
    fibrous,
    stretch: mix(1, CIRRUS_STRETCH, fibrous),
    steepness: 1 / mix(strengthForm.edgeWidth, strengthForm.cirrusEdgeWidth, fibrous),
    sharpness: mix(erosionForm.smoothSharpness, erosionForm.erodedSharpness, eroded),
    coarseness: towers,
    anvil: towers * Math.min(Math.max(tall, 0), 1)
  }
}
