import type { CloudLayerParameters } from './CloudLayer'
import { densityForm } from '../density/formConstants'

/** Vectors that a layer takes in the uniform array of all layers: `CloudField` writes them, `layerAt` reads them. */
export const LAYER_STRIDE = 27

/** Vectors of a layer that camera and wind move: from the first on, so many, and the last ones, of the mesoscale's lattice. */
export const movedVectors = { first: 3, count: 16, last: 3 } as const

/** Periods of a layer's look-ups of noise, for a layer 1200 m thick. */
export const noisePeriods = {
  /**
   * Period of the weather texture for cumulus, and for other kinds [m]. Greater: larger clouds, farther apart
   * (*Cumulus*).
   */
  cumulus: 6400,
  weather: 12_800,
  /** Period of the shape texture [m]. Greater: broader billows, smoother clouds (*Cumulus*). */
  shape: 6400 / 3,
  /** Period of the detail texture, in periods of the shape. Greater: coarser wisps at edges (*Inside a cloud*). */
  detail: 3 / 16,
  /**
   * Period of the weather texture where it holds the fields that clouds gather in, in periods of the weather:
   * irrational, so that both have no common period. Greater: larger fields, farther apart (*Cockpit*).
   */
  fields: 3 * Math.sqrt(6),
  /**
   * Period of the weather texture where it holds what gathers fields: clusters and bands of 15 to 170 km [m]. Greater:
   * seen from orbit, pepper between regions (*World clouds from 12,000 km*, without its map).
   */
  mesoscale: 380_000,
  /**
   * Period of the weather texture where it holds the systems of whole regions [m]. Greater: broader fronts
   * and clear zones (*World clouds from 12,000 km*, without its map).
   */
  regions: 2_300_000
} as const

/**
 * Displacement of all of a layer's look-ups by its fields, and by the regions [periods of the weather]:
 * repetitions fall out of step. 0: the same clouds and billows again and again, in rows (*World clouds*,
 * without its map); much greater: clouds are drawn out.
 */
export const weatherShifts = { fields: 0.25, regions: 0.5 } as const

/**
 * Shift of the mesoscale by the regions [periods of the mesoscale]: bands bend into arcs and hooks. 0: straight rows (*World
 * clouds from 12,000 km*, without its map).
 */
export const MESOSCALE_WARP = 0.35

/**
 * Shift of a world map's look-up by the fields, for texels of an angle [rad] seen from the planet's centre: half a
 * texel to either side, as far as fields are large enough for that [rad]. 0: the map's texels show as
 * squares near the ground (*World clouds*).
 */
export const mapShift = (texel: number): number => Math.min(texel, 0.003)

/** Waves around the planet. */
export const waveForm = {
  /**
   * Wave numbers of each axis along the two others [rad]. Greater: shorter waves (*World clouds from 12,000 km*,
   * without its map).
   */
  next: 3.1,
  last: 1.7,
  /**
   * Shift of the regions by the waves [periods of the regions]. 0: regions repeat every 2,300 km (*World clouds
   * from 12,000 km*, without its map).
   */
  warp: 0.22
} as const

/**
 * Weights of the scales that the weather is the sum of, with that of single clouds 1. A greater one gathers
 * clouds more at its scale, with more clear sky between: *Cockpit* for fields and cells, *World clouds from
 * 12,000 km* without its map for the others.
 */
export const scaleWeights = {
  /** Fields of tens of kilometres, of the layer's own weather and of large cells. */
  fields: 0.6,
  cells: 0.5,
  /** Clusters and bands of 15 to 170 km. */
  mesoscale: 0.52,
  regions: 0.4,
  /** Fronts and belts: density/systemsForm.ts. */
  planet: 0.75,
  /** Part by which the last one is more in storms. 0: storms of one size all over the planet (*World clouds*, without its map). */
  storms: 0.8,
  /** Share of finer cells in the regions. 0: their edges have no finer structure. */
  regionCells: 0.6,
  /** Share of bands in the mesoscale and in the regions. 0: round clusters alone, no fronts. */
  bands: 0.7,
  regionBands: 0.8
} as const

/** Ratio of length to width of cirrus' noise [–]. Smaller: blobs instead of fibres (*Cirrus*). */
const CIRRUS_STRETCH = 9

const shareOf = (weights: readonly number[], index: number): number =>
  weights[index] ** 2 / (weights.reduce((sum, weight) => sum + weight ** 2, 0) || 1)

/**
 * Periods of a layer's noise [m]: tall clouds are broad and have large billows. In powers of 2, or else every
 * change of an altitude would move the noise, which is anchored at the planet's centre.
 */
export function layerPeriods({
  baseAltitude,
  topAltitude,
  weatherWeights,
  weatherScale,
  shapeScale,
  detailScale
}: CloudLayerParameters): { weather: number; shape: number; detail: number } {
  const octaves = Math.log2((topAltitude - baseAltitude) / 1200)
  const scale = (share: number): number =>
    2 ** Math.min(Math.max(Math.round(share * octaves), -2), 2)
  const isCumulus = shareOf(weatherWeights, 0) > 0.5
  const shape = noisePeriods.shape * scale(0.5) * shapeScale
  return {
    weather: (isCumulus ? noisePeriods.cumulus : noisePeriods.weather) * scale(0.45) * weatherScale,
    shape,
    detail: noisePeriods.detail * shape * detailScale
  }
}

/** Deviation of the regions' channels, over that of one. */
export const REGION_SIZE = Math.hypot(1, scaleWeights.regionCells, scaleWeights.regionBands)

/** Factor of the mesoscale over that of the regions: the same for all layers. */
export const MESOSCALE_PER_REGIONS =
  ((scaleWeights.mesoscale / scaleWeights.regions) * REGION_SIZE) /
  Math.hypot(1, scaleWeights.bands)

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
 * @param hasMap - True if a map has what is larger than fields.
 * @param openCells - Share of open cells in stratocumulus, in [0, 1]: turns its sign.
 */
export function weatherScales(
  weights: readonly number[],
  hasMap: boolean,
  openCells = 0
): WeatherScales {
  const size = Math.hypot(...weights) || 1
  const unit = weights.map(weight => weight / size)
  // Large cells are the third channel.
  const fieldVariance =
    scaleWeights.fields ** 2 +
    scaleWeights.cells ** 2 +
    2 * scaleWeights.fields * scaleWeights.cells * (unit[2] ?? 0)
  const { mesoscale, regions, planet, storms } = scaleWeights
  const large = hasMap ? 0 : 1
  const systems = planet * (1 + storms * (unit[2] ?? 0) ** 2)
  const variance = 1 + fieldVariance + large * (mesoscale ** 2 + regions ** 2 + systems ** 2)
  const factor = Math.sqrt(12 / variance)
  const [a, b, c, d] = unit.map(weight => weight * factor)
  // From closed cells to open ones by way of cumulus: the variance stays.
  const closed = 1 - 2 * openCells
  return {
    clouds: [Math.hypot(a, b * Math.sqrt(1 - closed ** 2)), b * closed, c, d],
    fields: scaleWeights.fields,
    cells: scaleWeights.cells * factor,
    regions: (large * regions * factor) / REGION_SIZE,
    planet: (large * systems) / Math.sqrt(variance),
    cloudVariance: 1 / variance,
    fieldVariance: fieldVariance / variance
  }
}

/**
 * Levels of detail by which the weather of cumulonimbus is coarser than that of cumulus. Smaller: storms thin out
 * between 1,000 and 4,000 km (*World clouds*).
 */
const CUMULONIMBUS_COARSENESS = 1.35

/** Forms that a layer's kind of weather gives its clouds. */
export function layerForms({ weatherWeights, edgeSoftness }: CloudLayerParameters): {
  /** Length over width of the noise that shapes them. */
  stretch: number
  /** Strength over which density rises at edges [–]. */
  edge: number
  /** Levels of detail by which its weather is coarser than others. */
  coarseness: number
} {
  const fibrous = shareOf(weatherWeights, 3)
  return {
    stretch: 1 + (CIRRUS_STRETCH - 1) * fibrous,
    edge: densityForm.crispEdge * densityForm.softEdge ** edgeSoftness,
    coarseness: CUMULONIMBUS_COARSENESS * shareOf(weatherWeights, 2)
  }
}
