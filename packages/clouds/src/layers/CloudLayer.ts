import { checkSpectrum, withDefaults } from '@welkin/atmosphere'
import { checkBoolean, checkFinite, checkOptions, fail } from '@welkin/geo'
import { checkRanges } from '../check'
import { parameterProperties } from '../parameterProperties'
import { checkedPrecipitation, type CloudPrecipitation } from './precipitation'

/** Horizontal velocity of the air at a layer [m/s], towards east and north. */
export interface CloudWind {
  /** Speed towards the east [m/s]. */
  readonly east: number
  /** Speed towards the north [m/s]. */
  readonly north: number
}

/** Everything that describes one layer of clouds. */
export interface CloudLayerParameters {
  /** Altitude of the layer's base above the ellipsoid [m], at least 0 and below `topAltitude`. */
  readonly baseAltitude: number
  /** Altitude of the layer's top above the ellipsoid [m], at most 30,000. */
  readonly topAltitude: number
  /** Share of the sky that the layer covers, in [0, 1]: of the planet's; regions have more or less. */
  readonly coverage: number
  /** Extinction coefficient of the densest cloud [1/m], in [0, 1]; cumulus has 0.05 to 0.1. */
  readonly density: number
  /**
   * Exponent t of the strength ĥ^t that a column needs to reach a height, in (0, 8], with ĥ the height
   * in the layer from 0 to 1. Smaller: only the strongest columns grow tall, and tops lie at all heights;
   * greater: nearly all of them reach the same height, as under an inversion. Without effect on storms.
   */
  readonly profileExponent: number
  /**
   * Height up to which weak columns have no cloud, over the layer's thickness, in [0, 1]: bases hang lower where clouds are
   * thick. 0: flat bases. Without effect on storms.
   */
  readonly baseRelief: number
  /** Amount of billows, bulges that meet in creases, in [0, 1]; 0 leaves smooth mounds. */
  readonly shapeAmount: number
  /** Amount of detail finer than the billows, down to 1 m near the camera, in [0, 1]. */
  readonly detailAmount: number
  /** Factor of the size and distance of single clouds, in [0.1, 10]. */
  readonly weatherScale: number
  /** Factor of the size of billows, in [0.1, 10]. */
  readonly shapeScale: number
  /** Factor of the size of detail, in [0.1, 10]. */
  readonly detailScale: number
  /** Softness of edges, in [0, 1]: 0 is crisp, as of growing cumulus, 1 fades out as cirrus does. */
  readonly edgeSoftness: number
  /** Turbulence that bends columns and drags their edges along, in [0, 2]; 1 is that of cumulus. */
  readonly turbulence: number
  /**
   * Horizontal displacement downwind per height above the base [m/m], in [−5, 5]: clouds lean, fall
   * streaks trail.
   */
  readonly shear: number
  /** Share of an anvil that towers spread into below the layer's top, in [0, 1]. */
  readonly anvil: number
  /** Share of open cells, with clear middles, in stratocumulus, in [0, 1]; 0 has closed ones. */
  readonly openCells: number
  /** Exponent g by which extinction grows with height in the lower part of the layer, ĥ^g, in [0, 4]; 0 is even. */
  readonly densityGrowth: number
  /**
   * Weights of the four kinds of weather in the layer, each in [0, 1]: cumulus, stratocumulus,
   * cumulonimbus, cirrus. A layer of cumulonimbus alone is made of single storms, each with a tower.
   */
  readonly weatherWeights: readonly [number, number, number, number]
  /** Wind that the layer drifts with [m/s]. */
  readonly wind: CloudWind
  /**
   * Rain, snow or hail from it; `clouds` must have a `precipitation` then. What is left out stays as it is. Null, the default, for nothing, and
   * for defaults from then on.
   */
  readonly precipitation: CloudPrecipitation | null
  /** True for a layer that casts shadows. */
  readonly shadow: boolean
}

/** Scattered fair-weather cumulus. */
const defaults: CloudLayerParameters = {
  baseAltitude: 1000,
  topAltitude: 2200,
  coverage: 0.35,
  density: 0.1,
  profileExponent: 0.62,
  baseRelief: 0,
  shapeAmount: 1,
  detailAmount: 1,
  weatherScale: 1,
  shapeScale: 1,
  detailScale: 1,
  edgeSoftness: 0.1,
  turbulence: 1,
  shear: 0.1,
  anvil: 0,
  openCells: 0,
  densityGrowth: 0.184,
  weatherWeights: [1, 0, 0, 0],
  wind: { east: 8, north: 0 },
  precipitation: null,
  shadow: true
}

const ranges = {
  baseAltitude: [0, 30_000],
  topAltitude: [0, 30_000],
  coverage: [0, 1],
  density: [0, 1],
  profileExponent: [Number.MIN_VALUE, 8],
  baseRelief: [0, 1],
  shapeAmount: [0, 1],
  detailAmount: [0, 1],
  weatherScale: [0.1, 10],
  shapeScale: [0.1, 10],
  detailScale: [0.1, 10],
  edgeSoftness: [0, 1],
  turbulence: [0, 2],
  shear: [-5, 5],
  anvil: [0, 1],
  openCells: [0, 1],
  densityGrowth: [0, 4]
} as const

function requireParameters(parameters: CloudLayerParameters): void {
  const where = 'CloudLayer'
  checkRanges(where, parameters, ranges)
  const { baseAltitude, topAltitude, wind } = parameters
  if (topAltitude <= baseAltitude) {
    fail(where, `topAltitude must be above baseAltitude (${baseAltitude} m)`, topAltitude)
  }
  checkSpectrum(where, 'weatherWeights', parameters.weatherWeights, 1)
  checkOptions(`${where}.wind`, wind, 'east', 'north')
  for (const name of ['east', 'north'] as const) checkFinite(where, `wind.${name}`, wind[name])
  checkBoolean(where, 'shadow', parameters.shadow)
}

/**
 * One layer of clouds between two altitudes.
 *
 * ```ts
 * const cirrus = new CloudLayer({ baseAltitude: 8500, topAltitude: 9500, density: 0.002 })
 * cirrus.coverage = 0.6
 * cirrus.set({ baseAltitude: 9000, topAltitude: 10_000 })
 * ```
 *
 * Each parameter is a property too; setting it checks it.
 */
export class CloudLayer {
  declare baseAltitude: CloudLayerParameters['baseAltitude']
  declare topAltitude: CloudLayerParameters['topAltitude']
  declare coverage: CloudLayerParameters['coverage']
  declare density: CloudLayerParameters['density']
  declare profileExponent: CloudLayerParameters['profileExponent']
  declare baseRelief: CloudLayerParameters['baseRelief']
  declare shapeAmount: CloudLayerParameters['shapeAmount']
  declare detailAmount: CloudLayerParameters['detailAmount']
  declare weatherScale: CloudLayerParameters['weatherScale']
  declare shapeScale: CloudLayerParameters['shapeScale']
  declare detailScale: CloudLayerParameters['detailScale']
  declare edgeSoftness: CloudLayerParameters['edgeSoftness']
  declare turbulence: CloudLayerParameters['turbulence']
  declare shear: CloudLayerParameters['shear']
  declare anvil: CloudLayerParameters['anvil']
  declare openCells: CloudLayerParameters['openCells']
  declare densityGrowth: CloudLayerParameters['densityGrowth']
  declare weatherWeights: CloudLayerParameters['weatherWeights']
  declare wind: CloudLayerParameters['wind']
  declare precipitation: CloudLayerParameters['precipitation']
  declare shadow: CloudLayerParameters['shadow']
  #parameters: CloudLayerParameters

  static {
    parameterProperties(CloudLayer.prototype, defaults, 'parameters')
  }

  /**
   * @param parameters - Values that differ from scattered fair-weather cumulus.
   * @throws Error naming the parameter and its value when one is out of its range.
   */
  constructor(parameters: Partial<CloudLayerParameters> = {}) {
    this.#parameters = merge(defaults, parameters)
  }

  /** The layer's parameters: a frozen object, replaced by each `set`. */
  get parameters(): CloudLayerParameters {
    return this.#parameters
  }

  /**
   * Changes some parameters; leaves the layer as it was when the result would not be valid.
   *
   * @throws Error naming the parameter and its value when one is out of its range.
   */
  set(changes: Partial<CloudLayerParameters>): this {
    this.#parameters = merge(this.#parameters, changes)
    return this
  }

  clone(): CloudLayer {
    return new CloudLayer(this.#parameters)
  }
}

function merge(
  base: CloudLayerParameters,
  changes: Partial<CloudLayerParameters>
): CloudLayerParameters {
  const merged = withDefaults('CloudLayer', base, changes)
  requireParameters(merged)
  const { precipitation } = merged
  return Object.freeze({
    ...merged,
    weatherWeights: Object.freeze([...merged.weatherWeights] as const),
    wind: Object.freeze({ ...merged.wind }),
    precipitation: precipitation && checkedPrecipitation(precipitation, base.precipitation)
  })
}
