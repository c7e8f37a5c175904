import { int, vec2, vec4 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import {
  MESOSCALE_WARP,
  noisePeriods,
  scaleWeights,
  waveForm,
  weatherShifts
} from '../../layers/layerUniforms'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { layerAt, type LayerNodes } from './layer'
import { planetWaves } from './planetWaves'
import { weatherLevel } from './resolution'
import { zenithAt, type CloudSample } from './sample'
import { cycloneAround, frontsAndBelts } from './weatherSystems'

/**
 * Weather of a layer on all scales larger than single clouds, packed: its part of the weather's sum, coverage,
 * and `shift`. It is smooth over kilometres.
 */
export type PackedBackground = Vec4

/** Weather of a layer on all scales larger than single clouds. */
export interface WeatherBackground {
  /** Part of the weather's sum, in standard deviations of the whole. */
  readonly sum: Float
  /** Share of the sky that the layer covers there, as far as it is known without noise. */
  readonly coverage: Float
  /** Displacement of noise along x and y of its lattices [m]: or else it would repeat. */
  readonly shift: Vec2
}

/** The background that was packed. */
export const unpackBackground = (packed: PackedBackground): WeatherBackground => ({
  sum: packed.x,
  coverage: packed.y,
  shift: vec2(packed.z, packed.w).toConst()
})

/** Weather of whole regions, which all layers share: where one is clear, others are. It is smooth over 100 km. */
export interface WeatherSystems {
  /** Noise of the regions, each channel in [−½, ½]. */
  readonly regions: Vec4
  /** Fronts and belts, of variance 1. */
  readonly systems: Float
  /** Displacement to where the air was before cyclones turned it, in the mapped space [m]. */
  readonly displacement: Vec3
}

/**
 * Weather of whole regions at a place: a texture read.
 *
 * @param subpoint - `subpointOffset` of the sample.
 * @param footprint - Width of what the sample stands for [m].
 */
export function weatherSystems(
  field: CloudField,
  subpoint: Vec3,
  footprint: Float
): WeatherSystems {
  const first = layerAt(field, int(0))
  // Of the subpoint itself: what cyclones displace it by must fit to the metre.
  const zenith = first.directionInSystems(zenithAt(field, subpoint)).normalize().toConst() as Vec3
  const waves = planetWaves(zenith).toConst() as Vec3
  const cyclone = cycloneAround(zenith)
  const displacement = first
    .directionFromSystems(cyclone.displacement)
    .mul(field.radius)
    .toConst() as Vec3
  const regions = field.textures.weather
    .sample(first.regionLattice(subpoint.add(displacement)).add(waves.mul(waveForm.warp)))
    .level(weatherLevel(footprint, 1 / noisePeriods.regions))
    .sub(0.5)
    .toConst() as Vec4
  return {
    regions,
    systems: frontsAndBelts(zenith, waves, regions, cyclone),
    displacement
  }
}

/** Clusters and bands in which fields gather: a texture read. */
const mesoscaleAt = (
  field: CloudField,
  layer: LayerNodes,
  subpoint: Vec3,
  { regions, displacement }: WeatherSystems,
  footprint: Float
): Vec4 =>
  field.textures.weather
    .sample(layer.mesoscaleLattice(subpoint.add(displacement)).add(regions.xyz.mul(MESOSCALE_WARP)))
    .level(weatherLevel(footprint, 1 / noisePeriods.mesoscale))
    .sub(0.5)
    .toConst()

/**
 * Looks the background up: three texture reads, and one of the world map.
 *
 * @param subpoint - `subpointOffset` of the sample: the weather is the same all the way up.
 * @param footprint - Width of what the sample stands for [m].
 * @param around - `weatherSystems` there.
 */
export function weatherBackground(
  field: CloudField,
  layer: LayerNodes,
  subpoint: Vec3,
  sample: Pick<CloudSample, 'up'>,
  footprint: Float,
  around = weatherSystems(field, subpoint, footprint)
): PackedBackground {
  const { regions, systems } = around
  const scale = layer.perWeatherPeriod.div(noisePeriods.fields).toConst() as Float
  const fields = field.textures.weather
    .sample(layer.fieldLattice(subpoint).add(regions.xyz.mul(weatherShifts.regions)))
    .level(weatherLevel(footprint, scale))
    .sub(0.5)
    .toConst() as Vec4
  const mesoscale = mesoscaleAt(field, layer, subpoint, around, footprint)
  const sum = fields
    .dot(layer.weights)
    .mul(scaleWeights.fields)
    .add(fields.z.mul(layer.cells))
    .add(mesoscale.x.add(mesoscale.w.mul(scaleWeights.bands)).mul(layer.mesoscale))
    .add(
      regions.z
        .add(regions.x.mul(scaleWeights.regionCells))
        .add(regions.w.mul(scaleWeights.regionBands))
        .mul(layer.regions)
    )
    .add(systems.mul(layer.planet))
  const period = layer.perWeatherPeriod.reciprocal()
  const shift = fields.xy
    .mul(weatherShifts.fields)
    .add(regions.xy.mul(weatherShifts.regions))
    .mul(period)
  const coverage =
    field.worldMap?.coverageAt(field, layer, sample.up, footprint, fields.zxy) ?? layer.coverage
  return vec4(sum, coverage, shift).toConst()
}
