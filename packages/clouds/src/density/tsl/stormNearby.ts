import { Fn, float, int, mat3, step, vec3, vec4 } from 'three/tsl'
import { select } from '../../select'
import { noisePeriods } from '../../layers/layerUniforms'
import { cellOf, digitsOf, hashCell, wrapped } from '../../noise/tsl/cellHash'
import {
  layout,
  loop,
  type Float,
  type Int,
  type Mat3,
  type Variable,
  type Vec2,
  type Vec3
} from '../../tsl-types'
import { stormPlaces } from '../stormForm'
import { inLattice } from './inLattice'
import type { LayerNodes } from './layer'

// The search for the nearest storm, which is long: samples near each other share one.

/** Square of the distance from a storm's axis, of which a point is `gap` away [cells²]. */
export const squareFrom = (gap: Vec3, up: Vec3): Float => {
  const height = gap.dot(up).toConst() as Float
  const square = height.mul(height).toConst() as Float
  const aside = square.mul(square).mul(square).mul(stormPlaces.away)
  return gap.dot(gap).sub(square).add(aside).max(0)
}

/** Storms around a place, as displacements to their axes in the lattice [cells]. */
export interface StormGaps {
  /** To the axis of the nearest anvil. */
  readonly anvil: Vec3
  /** To the axis of the anvil whose tower is nearest: where storms crowd, it may be that of another storm. */
  readonly tower: Vec3
  /** Distance from the axis of the next nearest anvil, less that from the nearest. */
  readonly lead: Float
  /** Distance from the axis of the next nearest tower, less that from the nearest. */
  readonly towerLead: Float
}

/**
 * Displacements to the nearest storms, as columns of a matrix, and both leads: `StormGaps`. Twin: `stormGaps` in
 * test/twins/storm.ts
 *
 * @param p - Place in the lattice, in its periods.
 * @param up - Zenith in the lattice, unit length.
 * @param downwind - Displacement from a storm's tower to the middle of its anvil, horizontal [cells].
 */
const gapsAround = /*#__PURE__*/ Fn(
  ([p, up, downwind]: [Vec3, Vec3, Vec3]) => {
    const { cells, seed, jitter } = stormPlaces
    const count = vec3(cells)
    const { base, part, origin, index } = cellOf(p, count, float(seed))
    // The eight nearest cells: towards the nearer neighbour along each axis.
    const side = step(vec3(0.5), part).mul(2).sub(1).toConst()
    const stride = wrapped(base.add(side), count).sub(origin).toConst()
    const anvil = vec4(0, 0, 0, 99).toVar()
    const tower = vec4(0, 0, 0, 99).toVar()
    /** Squares of the distances from the next nearest ones. */
    const [next, nextTower] = [0, 1].map(() => float(99).toVar() as Float)
    loop('stormCell', 8, corner => {
      const digits = digitsOf(corner, 2).toConst()
      const place = hashCell(index.add(stride.mul(digits)))
        .mul(jitter)
        .add((1 - jitter) / 2)
      const gap = side.mul(vec3(digits)).add(place).sub(part).toConst()
      const square = squareFrom(gap, up).toConst()
      const isNearer = square.lessThan(anvil.w).toConst()
      next.assign(select(isNearer, anvil.w, next.min(square)))
      anvil.assign(select(isNearer, vec4(gap, square), anvil))
      // Less what is the same for all.
      const fromTower = square.sub(downwind.dot(gap).mul(2)).toConst()
      const isNearerTower = fromTower.lessThan(tower.w).toConst()
      nextTower.assign(select(isNearerTower, tower.w, nextTower.min(fromTower)))
      tower.assign(select(isNearerTower, vec4(gap, fromTower), tower))
    })
    const same = downwind.dot(downwind).toConst()
    const lead = (nearest: Float, second: Float): Float => second.sqrt().sub(nearest.sqrt())
    const ofTowers = lead(tower.w.add(same).max(0), nextTower.add(same).max(0))
    return mat3(anvil.xyz, tower.xyz, vec3(lead(anvil.w, next), ofTowers, 0))
  },
  layout('welkinStormGaps', 'mat3', { p: 'vec3', up: 'vec3', downwind: 'vec3' })
) as unknown as (p: Vec3, up: Vec3, downwind: Vec3) => Mat3

/** A matrix whose columns are read, which its type lacks. */
interface Columns {
  element: (index: Int) => Vec3
}

/** Displacements to the nearest storms: see `gapsAround`. */
export function stormGaps(p: Vec3, up: Vec3, downwind: Vec3): StormGaps {
  const gaps = gapsAround(p, up, downwind).toConst() as unknown as Columns
  const [anvil, tower, leads] = [0, 1, 2].map(column => gaps.element(int(column)))
  return { anvil, tower, lead: leads.x.toConst(), towerLead: leads.y.toConst() }
}

/** Place in the lattice of storms, in its periods, of a displaced look-up. */
export const placeOf = (layer: LayerNodes, subpoint: Vec3, shift: Vec2): Vec3 =>
  layer
    .fieldLattice(subpoint)
    .add(inLattice(shift).mul(layer.perWeatherPeriod.div(noisePeriods.fields)))
    .toConst()

/** Form of all storms around a place: it changes over many kilometres. */
export interface StormFrame {
  /** Zenith in their lattice. */
  readonly zenith: Vec3
  /** Displacement from a storm's tower to the middle of its anvil, horizontal [cells]. */
  readonly downwind: Vec3
  /** `stormRadius` [m]. */
  readonly radius: Float
}

/**
 * The storms nearest to a place, kept for places nearby: points of their axes in the lattice [cells], as of `StormGaps`, and
 * their frame.
 */
export interface StormNearby extends StormGaps, StormFrame {}

/** Variables that hold it. */
export type KeptStorm = { readonly [Key in keyof StormNearby]: Variable<StormNearby[Key]> }

/** Variables for the nearest storms. To be called inside of a shader function. */
export const keptStorm = (): KeptStorm => ({
  anvil: vec3(0).toVar(),
  tower: vec3(0).toVar(),
  lead: float(0).toVar(),
  towerLead: float(0).toVar(),
  zenith: vec3(0).toVar(),
  downwind: vec3(0).toVar(),
  radius: float(0).toVar()
})

/** Keeps the nearest storms. */
export function keepStorm(kept: KeptStorm, found: StormNearby): void {
  for (const key of Object.keys(kept) as (keyof StormNearby)[]) {
    kept[key].assign(found[key] as Vec3 & Float)
  }
}

/** Length of a cell [m]. */
export const cellLength = (layer: LayerNodes): Float =>
  layer.perWeatherPeriod
    .mul(stormPlaces.cells / noisePeriods.fields)
    .reciprocal()
    .toConst()

/** Rank of a distance [cells] from the nearest storm among all places of the planet, in [0, 1]: 1 at none. */
export const stormRank = (cells: Float): Float =>
  cells.div(stormPlaces.scale).max(1e-4).pow(stormPlaces.power).negate().exp().toConst()

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
