import { Fn, float, smoothstep, vec3, vec4 } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../../density/CloudField'
import type { LayerNodes } from '../../density/tsl/layer'
import { resolutionAt } from '../../density/tsl/resolution'
import { ifStorm } from '../../density/tsl/storm'
import { cellLength, stormRank } from '../../density/tsl/stormNearby'
import { cloudWeather } from '../../density/tsl/weather'
import { unpackBackground, type PackedBackground } from '../../density/tsl/weatherBackground'
import { layout, type Float, type Variable, type Vec2, type Vec3, type Vec4 } from '../../tsl-types'
import { columnForm } from '../fallForm'

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
  /** Optical depths of `FallColumn.parts`. */
  readonly parts: Vec3
  /** Wind's axis times half its growth with height [1/s], and times the layer's shear [–]: downwind is `cross(·, zenith)`. */
  readonly windAxis: Vec3
  readonly shearAxis: Vec3
}

/**
 * Share of all columns whose weather is stronger, by the logit of what the normal distribution has [–]: sums of a few noises have shorter
 * tails. Twin: test/twins/precipitation.ts
 */
const strongerShare = /*#__PURE__*/ Fn(
  ([logit]: [Float]) =>
    logit.mul(logit.mul(logit).mul(columnForm.tail).add(1)).negate().exp().add(1).reciprocal(),
  layout('precipitationStronger', 'float', { logit: 'float' })
)

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
  /** Share of the columns with clouds that are stronger. */
  const stronger = float(1).toVar() as Variable<Float>
  ifStorm(
    layer,
    () => {
      // A storm's rain falls about its tower, which stands aside of its anvil.
      const { towerDistance, stormRadius } = weather
      const length = cellLength(layer)
      const kept = resolution.cloudsLost.oneMinus().sqrt()
      const nearer = stormRank(towerDistance.div(length)).sub(0.5).mul(kept).sub(0.5).negate()
      const clouded = stormRank(stormRadius.div(length)).oneMinus().max(1e-5)
      const grown = smoothstep(0, columnForm.grown, stormRadius.div(layer.thickness))
      stronger.assign(nearer.div(clouded).pow(columnForm.near).div(grown.max(1e-3)))
    },
    () => {
      const odds = coverage.div(coverage.oneMinus().max(1e-6)).max(1e-6)
      stronger.assign(strongerShare(weather.sum.mul(-1.702)).div(strongerShare(odds.log())))
    }
  )
  const rank = stronger.div(share.max(1e-4)).oneMinus().max(-1)
  return vec4(select(coverage.greaterThan(0), rank, -1), 0, shift).toConst()
}
