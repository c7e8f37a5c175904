import { Fn, If, bool, float, mix, smoothstep } from 'three/tsl'
import { noisePeriods } from '../../layers/layerUniforms'
import { layout, type Bool, type Float, type Vec2, type Vec3 } from '../../tsl-types'
import { stormPlaces, stormShape } from '../stormForm'
import type { LayerNodes } from './layer'
import { placeOf, squareFrom, stormGap, type StormNearby } from './stormNearby'

// Storms: layers of the weather of cumulonimbus alone. Noise cut at a threshold has no anatomy; a storm has a place, a
// tower and an anvil, and its surface is a distance [m], so that billows stand out as far to all sides.

/** A storm around a place. */
export interface StormAround {
  /** Distance from its axis [m]; a storm that stands aside of the surface is as far away at least. */
  readonly distance: Float
  /** Rank of that distance among all places of the planet, in [0, 1]: 1 on the axis. */
  readonly rank: Float
}

/** True for layers of storms. */
export const isStorm = ({ weights, hasStorms }: LayerNodes): Bool =>
  hasStorms === undefined
    ? weights.z.greaterThan(0).and(weights.x.add(weights.y).add(weights.w.abs()).equal(0))
    : bool(hasStorms)

/** Code for layers of storms and for others: only one of both where the kind is known. */
export function ifStorm(layer: LayerNodes, storm: () => void, other: () => void): void {
  if (layer.hasStorms === undefined) If(isStorm(layer), storm).Else(other)
  else if (layer.hasStorms) storm()
  else other()
}

/** Length of a cell [m]. */
const cellLength = (layer: LayerNodes): Float =>
  layer.perWeatherPeriod
    .mul(stormPlaces.cells / noisePeriods.fields)
    .reciprocal()
    .toConst()

/**
 * The storm around a place.
 *
 * @param subpoint - As of `cloudWeather`.
 * @param up - Zenith there, in the mapped space.
 * @param bent - Displacement of the look-up along two axes of the lattice [m].
 * @param nearby - The nearest storm, if it is known; left out, it is looked for.
 */
export function stormAround(
  layer: LayerNodes,
  subpoint: Vec3,
  up: Vec3,
  bent: Vec2,
  nearby?: StormNearby
): StormAround {
  const { scale, power, cells: count } = stormPlaces
  const zenith = layer.directionInFields(up).toConst() as Vec3
  const place = placeOf(layer, subpoint, bent)
  const gap = nearby?.gap.sub(place.sub(nearby.place).mul(count)) ?? stormGap(place, zenith)
  const cells = squareFrom(gap.toConst(), zenith).sqrt().toConst() as Float
  return {
    distance: cells.mul(cellLength(layer)).toConst(),
    rank: cells.div(scale).max(1e-4).pow(power).negate().exp().toConst()
  }
}

/**
 * Radius of storms where a background of the weather is [m]: their rims have the rank that their coverage asks for.
 *
 * @param background - Part of the weather's sum.
 * @param quantile - ln(c / (1 − c)) / 1.702 of the coverage c.
 */
export function stormRadius(layer: LayerNodes, background: Float, quantile: Float): Float {
  const { scale, power, ranks } = stormPlaces
  const rank = background.add(quantile).div(layer.weights.z).oneMinus().sub(0.5)
  return rank
    .clamp(...ranks)
    .log()
    .negate()
    .pow(1 / power)
    .mul(cellLength(layer).mul(scale))
    .toConst()
}

/**
 * Distance into a storm's body, without billows [m]: a tower with a dome, an anvil, and a smooth union of both. Negative
 * outside. Float64: layers/stormBody.ts.
 *
 * @param distance - Distance from its axis [m].
 * @param radius - `stormRadius` [m].
 * @param height - ĥ in the layer, in [0, 1].
 */
export const stormBody = /*#__PURE__*/ Fn(
  ([distance, radius, height, thickness, anvilShare]: [Float, Float, Float, Float, Float]) => {
    const { tower, leastTower, widening, narrowing, dome, anvil, above, below, blend } = stormShape
    const { anvilFrom, grown, least } = stormShape
    const aspect = radius.div(thickness).toConst() as Float
    const tall = aspect.div(grown).clamp(0, 1).sqrt().max(least).mul(thickness).toConst() as Float
    const y = height.mul(thickness).toConst() as Float
    const narrow = radius.mul(tower).max(thickness.mul(leastTower).min(radius)).toConst()
    const base = mix(radius, narrow, anvilShare).toConst() as Float
    const wide = mix(base, radius, anvilShare.mul(smoothstep(...anvilFrom, aspect))).toConst()
    const [atBase, atTop] = [0, 1].map(end => mix(float(narrowing[end]), widening[end], anvilShare))
    const column = base.mul(mix(atBase, atTop, height)).toConst() as Float
    const overDome = y.sub(tall.mul(dome).sub(column).max(0)).max(0).toConst()
    const inTower = column.sub(distance.mul(distance).add(overDome.mul(overDome)).sqrt()).toConst()
    const rise = y.sub(tall.mul(anvil)).toConst() as Float
    const depth = tall.mul(rise.greaterThan(0).select(float(above), float(below))).toConst()
    // Distance from an ellipsoid, to first order.
    const [across, up] = [distance.div(wide).toConst(), rise.div(depth).toConst()]
    const norm = across.mul(across).add(up.mul(up)).sqrt().toConst()
    const slope = across.div(wide)
    const steep = up.div(depth)
    const gradient = slope.mul(slope).add(steep.mul(steep)).sqrt().max(1e-6)
    const inAnvil = norm.oneMinus().mul(norm.div(gradient)).toConst() as Float
    const soft = tall.mul(blend).toConst() as Float
    const share = inTower.sub(inAnvil).div(soft).mul(0.5).add(0.5).clamp(0, 1).toConst() as Float
    return mix(inAnvil, inTower, share).add(soft.mul(share).mul(share.oneMinus()))
  },
  layout('welkinStormBody', 'float', {
    distance: 'float',
    radius: 'float',
    height: 'float',
    thickness: 'float',
    anvilShare: 'float'
  })
) as unknown as (
  distance: Float,
  radius: Float,
  height: Float,
  thickness: Float,
  anvilShare: Float
) => Float
