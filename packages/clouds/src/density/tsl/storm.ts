import { Fn, If, bool, float, mix, smoothstep, step, vec3, vec4 } from 'three/tsl'
import { noisePeriods } from '../../layers/layerUniforms'
import { cellOf, digitsOf, hashCell, wrapped } from '../../noise/tsl/cellHash'
import {
  layout,
  loop,
  type Bool,
  type Float,
  type Variable,
  type Vec2,
  type Vec3
} from '../../tsl-types'
import { stormPlaces, stormShape } from '../stormForm'
import { inLattice, type LayerNodes } from './layer'

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
    : (bool(hasStorms) as Bool)

/** Code for layers of storms and for others: only one of both where the kind is known. */
export function ifStorm(layer: LayerNodes, storm: () => void, other: () => void): void {
  if (layer.hasStorms === undefined) If(isStorm(layer), storm).Else(other)
  else if (layer.hasStorms) storm()
  else other()
}

/** Square of the distance from a storm's axis, of which a point is `gap` away [cells²]. */
const squareFrom = (gap: Vec3, up: Vec3): Float => {
  const height = gap.dot(up).toConst() as Float
  const square = height.mul(height).toConst() as Float
  const aside = square.mul(square).mul(square).mul(stormPlaces.away)
  return gap.dot(gap).sub(square).add(aside).max(0)
}

/**
 * Displacement to the nearest storm. Twin of its length: `stormDistance` in test/twins/storm.ts
 *
 * @param p - Place in the lattice, in its periods.
 * @param up - Zenith in the lattice, unit length.
 * @returns To a point of its axis, in the lattice [cells]
 */
const stormGap = /*#__PURE__*/ Fn(
  ([p, up]: [Vec3, Vec3]) => {
    const { cells, seed, jitter } = stormPlaces
    const count = vec3(cells)
    const { base, part, origin, index } = cellOf(p, count, float(seed))
    // The eight nearest cells: towards the nearer neighbour along each axis.
    const side = step(vec3(0.5), part).mul(2).sub(1).toConst()
    const stride = wrapped(base.add(side), count).sub(origin).toConst()
    const nearest = vec4(0, 0, 0, 99).toVar()
    loop('stormCell', 8, corner => {
      const digits = digitsOf(corner, 2).toConst()
      const place = hashCell(index.add(stride.mul(digits)))
        .mul(jitter)
        .add((1 - jitter) / 2)
      const gap = side.mul(vec3(digits)).add(place).sub(part).toConst()
      const square = squareFrom(gap, up).toConst()
      nearest.assign(square.lessThan(nearest.w).select(vec4(gap, square), nearest))
    })
    return nearest.xyz
  },
  layout('welkinStormGap', 'vec3', { p: 'vec3', up: 'vec3' })
) as unknown as (p: Vec3, up: Vec3) => Vec3

/** Place in the lattice of storms, in its periods, of a displaced look-up. */
const placeOf = (layer: LayerNodes, subpoint: Vec3, bent: Vec2): Vec3 =>
  layer
    .fieldLattice(subpoint)
    .add(inLattice(bent).mul(layer.perWeatherPeriod.div(noisePeriods.fields)))
    .toConst() as Vec3

/** The storm nearest to a place, kept for places nearby. */
export interface StormNearby {
  /** The place in the lattice, in its periods. */
  readonly place: Vec3
  /** Displacement from there to a point of the storm's axis, in the lattice [cells]. */
  readonly gap: Vec3
}

/** Variables that hold it. */
export type KeptStorm = { readonly [Key in keyof StormNearby]: Variable<Vec3> }

/**
 * The storm nearest to a place, without turbulence.
 *
 * @param subpoint - As of `cloudWeather`.
 * @param up - Zenith there, in the mapped space.
 * @param shift - `shift` of `WeatherBackground` [m].
 */
export function stormNearby(layer: LayerNodes, subpoint: Vec3, up: Vec3, shift: Vec2): StormNearby {
  const place = placeOf(layer, subpoint, shift)
  const gap = stormGap(place, layer.directionInFields(up).toConst()).toConst() as Vec3
  return { place, gap }
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
  const cells = squareFrom(gap.toConst() as Vec3, zenith)
    .sqrt()
    .toConst() as Float
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
    const { tower, leastTower, widening, dome, anvil, above, below, blend } = stormShape
    const { anvilFrom, grown, least } = stormShape
    const aspect = radius.div(thickness).toConst() as Float
    const tall = aspect.div(grown).clamp(0, 1).sqrt().max(least).mul(thickness).toConst() as Float
    const y = height.mul(thickness).toConst() as Float
    const narrow = radius.mul(tower).max(thickness.mul(leastTower).min(radius)).toConst()
    const base = mix(radius, narrow, anvilShare).toConst() as Float
    const wide = mix(base, radius, anvilShare.mul(smoothstep(...anvilFrom, aspect))).toConst()
    const column = base
      .mul(height.mul(widening[1] - widening[0]).add(widening[0]))
      .toConst() as Float
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
