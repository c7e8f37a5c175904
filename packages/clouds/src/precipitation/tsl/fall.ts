import { Fn, If, float, smoothstep, vec2 } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../../density/CloudField'
import { billows, levelOf } from '../../density/tsl/billows'
import type { LayerNodes } from '../../density/tsl/layer'
import { subpointOffset, type CloudSample } from '../../density/tsl/sample'
import { backgroundAt } from '../../density/tsl/sampler'
import { strengthForm } from '../../density/formConstants'
import type { WeatherMap } from '../../density/WeatherMap'
import { NOISE_SIZE } from '../../noise/noiseSizes'
import {
  layout,
  loop,
  type Bool,
  type Float,
  type Int,
  type Variable,
  type Vec2,
  type Vec3
} from '../../tsl-types'
import { fallForm } from '../fallForm'
import { fallColumn, type FallNodes } from './fallColumn'
import { fallStreak } from './fallStreak'

/** Precipitation at a place. */
export interface Fallen {
  /** Rates of water [mm/h] that fall as drops or flakes, and as hail. */
  readonly rate: Float
  readonly hail: Float
  /** Share of snow, in [0, 1]. */
  readonly snow: Float
  /** Rank of the column above among those from which it falls, in (0, 1]; 0 or less where none does, down to −1 far from any. */
  readonly rank: Float
}

/**
 * Distance by which precipitation lags behind the cloud that it left, over the wind's growth with height: (x) of
 * ½ dU/dz [m s], (y) of the cloud's lean [m]. In wind that grows evenly with height its path is a parabola (Marshall 1953), flat while it is snow.
 * Twin: test/twins/precipitation.ts
 *
 * @param altitude - Altitude of the place [m].
 * @param base - Altitude of the cloud's base [m].
 */
export const fallLag = /*#__PURE__*/ Fn(
  ([altitude, base, freezingLevel]: [Float, Float, Float]) => {
    const depth = base.sub(altitude).max(0).toConst()
    const asSnow = base.sub(freezingLevel).clamp(0, depth).toConst()
    const snow = asSnow.mul(asSnow).toConst()
    const rain = depth.mul(depth).sub(snow)
    return vec2(snow.div(fallForm.snowSpeed).add(rain.div(fallForm.rainSpeed)), depth)
  },
  layout('precipitationLag', 'vec2', { altitude: 'float', base: 'float', freezingLevel: 'float' })
)

/**
 * Rate at a depth below the base [mm/h]: (n + 1) xⁿ times the mean at the base, less what has evaporated. Ranks x are equally frequent, so
 * that the mean over all columns from which it falls is the rate asked for. Twin: test/twins/precipitation.ts
 *
 * @param rank - x of the column, in [0, 1].
 * @param streak - Factor, of mean 1.
 * @param depth - Depth of fall, over that of virga [–].
 */
export const fallRate = /*#__PURE__*/ Fn(
  ([rate, rank, streak, depth]: [Float, Float, Float, Float]) => {
    const { core, evaporation: b } = fallForm
    const falling = rank
      .pow(core)
      .mul(streak)
      .mul(rate)
      .mul(core + 1)
      .toVar() as Variable<Float>
    If(depth.greaterThan(0), () => {
      const left = falling.pow(b).sub(rate.pow(b).mul(depth)).max(0)
      falling.assign(left.pow(1 / b))
    })
    return falling
  },
  layout('precipitationRate', 'float', {
    rate: 'float',
    rank: 'float',
    streak: 'float',
    depth: 'float'
  })
)

/** Share of snow at an altitude [m], in [0, 1]. */
export const snowShare = (altitude: Float, freezingLevel: Float): Float =>
  smoothstep(freezingLevel.sub(fallForm.melting), freezingLevel, altitude).toConst()

/** Place at which something falls from a layer, and the layer. */
interface FallPlace {
  readonly field: CloudField
  readonly map: WeatherMap | undefined
  readonly layer: LayerNodes
  readonly nodes: FallNodes
  readonly sample: CloudSample
  /** Depth of fall, and width of what the sample stands for [m]. */
  readonly depth: Float
  readonly footprint: Float
  /** Place among drops and flakes by their speeds, in [−½, ½); undefined for the mean. */
  readonly speed: Float | undefined
}

/**
 * Rate [mm/h] and rank of the column from which something falls that lags by `lag`, of {@link fallLag}: its cloud has drifted downwind since,
 * faster than it, as wind grows with height. The column's rank is looked up there; streaks are billows of the cloud at the same point.
 */
function fallAlong(
  lag: Vec2,
  { field, map, layer, nodes, sample, depth, footprint, speed }: FallPlace
): { rate: Variable<Float>; rank: Variable<Float> } {
  const rate = float(0).toVar() as Variable<Float>
  const rank = float(0).toVar() as Variable<Float>
  const { baseAltitude } = layer
  const { altitude, up, distance } = sample
  const aside = nodes.windAxis.mul(lag.x).add(nodes.shearAxis.mul(lag.y))
  const drift = aside.cross(up).toConst() as Vec3
  const offset = sample.offset.add(drift).toConst() as Vec3
  // Streaks stay sharp: drops that have left a cloudlet together are of one size where they arrive together.
  const more = speed?.mul(2 * fallForm.lagSpread).mul(lag.x)
  const from = more ? offset.add(nodes.windAxis.mul(more).cross(up)).toConst() : offset
  const above: CloudSample = { offset: from, altitude, up, distance }
  const subpoint = subpointOffset(field, above).toConst() as Vec3
  const column =
    map?.fallAt(layer.index, subpoint) ??
    fallColumn(field, layer, nodes, backgroundAt(field, layer, above), subpoint, footprint)
  rank.assign(column.x)
  If(rank.greaterThan(0), () => {
    const rise = layer.thickness.mul(fallForm.streakHeight).add(baseAltitude).sub(altitude)
    const source = offset.add(up.mul(rise)).toConst() as Vec3
    const blur = drift.length().mul(fallForm.lagBlur).add(depth.mul(fallForm.fallBlur))
    const width = footprint.max(blur).mul(layer.perShapePeriod)
    const level = levelOf(width, 1 / NOISE_SIZE.shape)
    const { coarse, fine } = billows(field, layer, source, column.zw, level)
    const noise = coarse.mul(fallForm.coarseStreaks).add(fine.mul(fallForm.fineStreaks))
    const lost = smoothstep(...strengthForm.billowLevels, level)
    const streak = fallStreak(noise, nodes.streaks.mul(layer.shapeAmount), lost)
    const onset = nodes.ceiling.sub(altitude).div(nodes.ceiling.sub(baseAltitude)).clamp()
    rate.assign(fallRate(nodes.rate, rank, streak, depth.mul(nodes.perVirga)).mul(onset))
  })
  return { rate, rank }
}

/** Share of hail in what falls from a column, over the layer's. */
const hailShare = (rank: Float): Float => smoothstep(...fallForm.hailFrom, rank)

/**
 * Precipitation of a layer at a place. To be called inside of a shader function.
 *
 * Stones fall faster than drops, and so nearer to where they come from: shafts of hail are steeper than the rain about them.
 *
 * @param speed - Place among drops and flakes by their speeds, in [−½, ½); left out, that of the mean.
 */
export function fallenFrom(
  field: CloudField,
  map: WeatherMap | undefined,
  layer: LayerNodes,
  nodes: FallNodes,
  sample: CloudSample,
  speed?: Float
): Fallen {
  const rate = float(0).toVar() as Variable<Float>
  const hail = float(0).toVar() as Variable<Float>
  const rank = float(-1).toVar() as Variable<Float>
  const { altitude, distance } = sample
  If(nodes.rate.greaterThan(0).and(altitude.lessThan(nodes.ceiling)), () => {
    const depth = layer.baseAltitude.sub(altitude).max(0).toConst() as Float
    const footprint = distance.mul(field.pixelAngle).toConst() as Float
    const place: FallPlace = { field, map, layer, nodes, sample, depth, footprint, speed }
    const lag = fallLag(altitude, layer.baseAltitude, nodes.freezingLevel).toConst() as Vec2
    const lagOfHail = vec2(depth.mul(depth).div(fallForm.hailSpeed), depth).toConst() as Vec2
    // One copy of the code for both: with two, WebGL compiles three times as long.
    const kinds = nodes.hail.greaterThan(0).toInt().add(1) as Int
    loop('fallKind', kinds, kind => {
      const isHail = kind.greaterThan(0).toConst() as Bool
      const fallen = fallAlong(select(isHail, lagOfHail, lag), place)
      const share = nodes.hail.mul(hailShare(fallen.rank)).toConst() as Float
      rank.assign(rank.max(fallen.rank))
      rate.addAssign(select(isHail, 0, fallen.rate.mul(share.oneMinus())))
      hail.addAssign(select(isHail, fallen.rate.mul(share), 0))
    })
  })
  return { rate, hail, snow: snowShare(altitude, nodes.freezingLevel), rank }
}
