import { int, log2 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { NOISE_SIZE } from '../../noise/noiseSizes'
import { latticeRotations } from '../lattice'
import { FIELD_PERIOD, PLANET_WARP, REGION_PERIOD, WEATHER_WARP } from '../../layers/layerUniforms'
import type { Float, Vec3, Vec4 } from '../../tsl-types'
import { coverageAt } from './coverage'
import { layerAt, rotate, type LayerNodes } from './layer'
import { planetWaves } from './planetWaves'
import { footprintOf, type CloudSample } from './sample'

/** The weather's noise at a place on its four scales, each less its mean, and levels of detail. */
export interface WeatherNoise {
  /** Share of the sky that the layer covers there: `coverageAt`. */
  coverage: Float
  /** Single clouds: a channel for each kind of weather, in [−½, ½]. */
  clouds: Vec4
  level: Float
  /** Fields that clouds gather in: the same channels. */
  fields: Vec4
  fieldLevel: Float
  /** Regions. */
  regions: Vec3
  regionLevel: Float
  /** Waves around the planet, in [−1, 1]. */
  waves: Vec3
}

/** Weather of whole regions and of the planet, which all layers share: where one is clear, others are. */
function weatherSystems(
  field: CloudField,
  layer: LayerNodes,
  subpoint: Vec3,
  sample: CloudSample,
  inLayer: Vec3,
  footprint: Float
): Pick<WeatherNoise, 'regions' | 'regionLevel' | 'waves'> {
  const isAlone = field.layers.length === 1
  const systems = isAlone ? layer : layerAt(field, int(0))
  const position = isAlone ? inLayer : (systems.mappedToLayer(subpoint).toConst() as Vec3)
  const zenith = systems.mappedToLayer(sample.up).toConst() as Vec3
  const waves = planetWaves(zenith)
  const regionLevel = log2(footprint.mul(NOISE_SIZE.weather / REGION_PERIOD).max(1)).toConst()
  const regions = field.textures.weather
    .sample(
      rotate(latticeRotations.region, position)
        .div(REGION_PERIOD)
        .add(systems.regionAnchor)
        .add(waves.mul(PLANET_WARP))
    )
    .level(regionLevel)
    .xyz.sub(0.5)
    .toConst() as Vec3
  return { regions, regionLevel: regionLevel, waves }
}

/**
 * Looks the weather up: three texture reads, and one of the world map.
 *
 * @param subpoint - `subpointOffset` of the sample: the weather is the same all the way up.
 */
export function weatherNoise(
  field: CloudField,
  layer: LayerNodes,
  subpoint: Vec3,
  sample: CloudSample
): WeatherNoise {
  const { weather } = field.textures
  const inLayer = layer.mappedToLayer(subpoint).toConst() as Vec3
  const footprint = footprintOf(field, sample)
  const systems = weatherSystems(field, layer, subpoint, sample, inLayer, footprint)
  const warp = systems.regions.mul(WEATHER_WARP).toConst() as Vec3
  const scale = layer.perWeatherPeriod
  const level = log2(footprint.mul(scale).mul(NOISE_SIZE.weather).max(1)).toConst() as Float
  const fieldLevel = level.sub(Math.log2(FIELD_PERIOD)).max(0).toConst() as Float
  const fields = weather
    .sample(
      rotate(latticeRotations.fields, inLayer)
        .mul(scale.div(FIELD_PERIOD))
        .add(layer.fieldAnchor)
        .add(warp)
    )
    .level(fieldLevel)
    .sub(0.5)
    .toConst() as Vec4
  const coverage = coverageAt(field, layer, sample, footprint, fields.zxy)
  const clouds = weather
    .sample(rotate(latticeRotations.weather, inLayer).mul(scale).add(layer.weatherAnchor).add(warp))
    .level(level)
    .sub(0.5)
    .toConst() as Vec4
  return { coverage, clouds, level, fields, fieldLevel, ...systems }
}
