import { Fn, float, mix, smoothstep, step, vec3 } from 'three/tsl'
import { noisePeriods } from '../../layers/layerUniforms'
import { cellOf, digitsOf, hashCell, wrapped } from '../../noise/tsl/cellHash'
import { layout, loop, type Bool, type Float, type Vec2, type Vec3 } from '../../tsl-types'
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
export const isStorm = ({ weights }: LayerNodes): Bool =>
  weights.z.greaterThan(0).and(weights.x.add(weights.y).add(weights.w.abs()).equal(0))

/**
 * Distance from the axis of the nearest storm. Twin: test/twins/storm.ts
 *
 * @param p - Place in the lattice, in its periods.
 * @param up - Zenith in the lattice, unit length.
 * @returns [cells]
 */
export const stormDistance = /*#__PURE__*/ Fn(
  ([p, up]: [Vec3, Vec3]) => {
    const { cells, seed, jitter, away } = stormPlaces
    const count = vec3(cells)
    const { base, part, origin, index } = cellOf(p, count, float(seed))
    // The eight nearest cells: towards the nearer neighbour along each axis.
    const side = step(vec3(0.5), part).mul(2).sub(1).toConst()
    const stride = wrapped(base.add(side), count).sub(origin).toConst()
    const nearest = float(9).toVar()
    loop('stormCell', 8, corner => {
      const digits = digitsOf(corner, 2).toConst()
      const place = hashCell(index.add(stride.mul(digits)))
        .mul(jitter)
        .add((1 - jitter) / 2)
      const gap = side.mul(vec3(digits)).add(place).sub(part).toConst()
      const height = gap.dot(up).toConst()
      const square = height.mul(height).toConst()
      const aside = square.mul(square).mul(square).mul(away)
      nearest.assign(nearest.min(gap.dot(gap).sub(square).add(aside)))
    })
    return nearest.max(0).sqrt()
  },
  layout('welkinStormDistance', 'float', { p: 'vec3', up: 'vec3' })
) as unknown as (p: Vec3, up: Vec3) => Float

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
 */
export function stormAround(layer: LayerNodes, subpoint: Vec3, up: Vec3, bent: Vec2): StormAround {
  const perPeriod = layer.perWeatherPeriod.div(noisePeriods.fields).toConst() as Float
  const place = layer.fieldLattice(subpoint).add(inLattice(bent).mul(perPeriod)).toConst() as Vec3
  const cells = stormDistance(place, layer.directionInFields(up).toConst())
  const { scale, power } = stormPlaces
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
