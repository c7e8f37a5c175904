import { vec3, vec4 } from 'three/tsl'
import type { CloudField } from '../../density/CloudField'
import type { LayerNodes } from '../../density/tsl/layer'
import { resolutionAt } from '../../density/tsl/resolution'
import { cloudWeather } from '../../density/tsl/weather'
import { unpackBackground, type PackedBackground } from '../../density/tsl/weatherBackground'
import { cumulative } from '../../noise/tsl/noiseChannels'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'

/** Precipitation of a layer, as shaders see it: lengths [m], rates [mm/h of water]. */
export interface FallNodes {
  readonly rate: Float
  readonly share: Float
  /** 1/depth of virga [1/m]; 0 where nothing evaporates. */
  readonly perVirga: Float
  readonly freezingLevel: Float
  readonly hail: Float
  /** Factor of the contrast of streaks [–]. */
  readonly streaks: Float
  /** Altitude above which nothing falls yet. */
  readonly ceiling: Float
  /** Wind's axis times half its growth with height [1/s], and times the layer's shear [–]: downwind is `cross(·, zenith)`. */
  readonly windAxis: Vec3
  readonly shearAxis: Vec3
}

/**
 * The column of a layer above a place: its rank among those from which it falls, in (0, 1], 0 or less where nothing does (x), and `shift` of
 * `WeatherBackground` (z, w). Twin of the rank: test/twins/precipitation.ts
 *
 * @param packed - Background of the weather there.
 * @param subpoint - `subpointOffset` of the place.
 * @param footprint - Width of what is asked for [m].
 */
export function fallColumn(
  field: CloudField,
  layer: LayerNodes,
  { share }: FallNodes,
  packed: PackedBackground,
  subpoint: Vec3,
  footprint: Float
): Vec4 {
  const background = unpackBackground(packed)
  const { coverage, shift } = background
  const still = vec3(0).xy as Vec2
  const resolution = resolutionAt(layer, footprint)
  const weather = cloudWeather(field, layer, background, subpoint, still, resolution)
  const columns = coverage.mul(share).max(1e-4)
  const rank = cumulative(weather.sum).oneMinus().div(columns).oneMinus().max(-1)
  return vec4(coverage.greaterThan(0).select(rank, -1), 0, shift).toConst()
}
