import { Fn, If, bool, float, mix, smoothstep } from 'three/tsl'
import { select } from '../../select'
import { layout, type Bool, type Float, type Vec2, type Vec3 } from '../../tsl-types'
import { stormFibres, stormPlaces, stormShape } from '../stormForm'
import { inLattice } from './inLattice'
import type { LayerNodes } from './layer'
import { fibrePlace } from './stormFibres'
import {
  cellLength,
  placeOf,
  squareFrom,
  stormGaps,
  stormRank,
  type StormNearby
} from './stormNearby'

// Storms: layers of the weather of cumulonimbus alone. Noise cut at a threshold has no anatomy; a storm has a place, a
// tower and an anvil, and its surface is a distance [m], so that billows stand out as far to all sides.

/** Storms around a place. */
export interface StormAround {
  /** Distance from the axis of the nearest anvil [m]; a storm that stands aside of the surface is as far away at least. */
  readonly distance: Float
  /** Distance from the axis of the nearest tower, which stands upwind of its anvil, measured alike [m]. */
  readonly towerDistance: Float
  /** Place in the noise that makes fibres, less its part by height [periods]. */
  readonly fibrePlace: Vec3
  /** Share of fibres, in [0, 1]: none midway between two storms, whose fibres differ. */
  readonly fibreShare: Float
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

/**
 * Distance of a storm's tower from the middle of its anvil, over the shear, which is not 0 [m]. Twin: `stormAside` in
 * test/twins/storm.ts
 */
const asidePerShear = ({ anvil, thickness }: LayerNodes, shear: Float, radius: Float): Float =>
  float(stormShape.mostAside)
    .div(shear.max(1e-6))
    .min(stormShape.aside)
    .mul(anvil)
    .mul(smoothstep(...stormShape.anvilFrom, radius.div(thickness)))
    .mul(radius)

/**
 * The storms nearest to a place, without turbulence: what `stormAround` takes as `nearby`.
 *
 * @param subpoint - As of `cloudWeather`.
 * @param up - Zenith there, in the mapped space.
 * @param shift - `shift` of `WeatherBackground` [m].
 * @param radius - `stormRadius` [m].
 */
export function stormNearby(
  layer: LayerNodes,
  subpoint: Vec3,
  up: Vec3,
  shift: Vec2,
  radius: Float
): StormNearby {
  const place = placeOf(layer, subpoint, shift)
  const zenith = layer.directionInFields(up).toConst() as Vec3
  const lean = layer.shearAxis.cross(up).toConst() as Vec3
  const aside = asidePerShear(layer, lean.length(), radius).mul(stormPlaces.cells)
  const downwind = layer.displacementInFields(lean).mul(aside).toConst() as Vec3
  const { anvil, tower, ...leads } = stormGaps(place, zenith, downwind)
  const at = place.mul(stormPlaces.cells).toConst() as Vec3
  return { anvil: at.add(anvil), tower: at.add(tower), ...leads, zenith, downwind, radius }
}

/**
 * The storms around a place: the nearest anvil, and the nearest tower, which may be another storm's. One storm alone
 * would end in a wall where another's anvil is nearer than its own.
 *
 * @param subpoint - As of `cloudWeather`.
 * @param shift - `shift` of `WeatherBackground` [m].
 * @param bend - Displacement by turbulence, along the same two axes of the lattice [m].
 * @param nearby - The nearest storms: `stormNearby`.
 */
export function stormAround(
  layer: LayerNodes,
  subpoint: Vec3,
  shift: Vec2,
  bend: Vec2,
  { anvil, tower, lead, towerLead, zenith, downwind, radius }: StormNearby
): StormAround {
  const at = placeOf(layer, subpoint, shift).mul(stormPlaces.cells).toConst() as Vec3
  const length = cellLength(layer)
  const bent = inLattice(bend).div(length).toConst() as Vec3
  // Midway between two storms there is none: it would be nearer to the one by it, and farther from the other.
  const perLead = length.div(layer.bend.mul(stormShape.steady).max(1)).toConst() as Float
  const gapTo = (axis: Vec3, ahead: Float): Vec3 =>
    axis
      .sub(at)
      .sub(bent.mul(ahead.mul(perLead).clamp()))
      .toConst()
  const toAnvil = gapTo(anvil, lead)
  // Smooth minimum of the distances to the nearest and the next: anvils that meet grow together.
  const meets = lead.div(stormPlaces.merge).oneMinus().max(0).toConst() as Float
  const merged = meets.mul(meets).mul(stormPlaces.merge / 4)
  const cells = squareFrom(toAnvil, zenith).sqrt().sub(merged).max(0).toConst() as Float
  const toTower = gapTo(tower, towerLead).sub(downwind).toConst() as Vec3
  return {
    distance: cells.mul(length).toConst(),
    towerDistance: squareFrom(toTower, zenith).sqrt().mul(length).toConst(),
    // From that anvil's own tower, not the nearest.
    fibrePlace: fibrePlace(anvil, downwind.sub(toAnvil), zenith, length),
    fibreShare: lead.mul(length).div(radius.mul(stormFibres.lead).max(1)).clamp().toConst(),
    rank: stormRank(cells)
  }
}

/**
 * Distance into a storm's body, without billows [m]: a tower with a dome, an anvil, and a smooth union of both. Negative
 * outside. Float64: layers/storms.ts.
 *
 * @param distance - Distance from the axis of its anvil [m].
 * @param towerDistance - Distance from the axis of its tower [m].
 * @param radius - `stormRadius` [m].
 * @param height - ĥ in the layer, in [0, 1].
 */
export const stormBody = /*#__PURE__*/ Fn(
  ([distance, towerDistance, radius, height, thickness, anvilShare]: [
    Float,
    Float,
    Float,
    Float,
    Float,
    Float
  ]) => {
    const { tower, leastTower, widening, narrowing, dome, anvil, above, below, blend } = stormShape
    const { anvilFrom, grown, least } = stormShape
    const aspect = radius.div(thickness).toConst() as Float
    const tall = aspect.div(grown).clamp().sqrt().max(least).mul(thickness).toConst() as Float
    const y = height.mul(thickness).toConst() as Float
    const narrow = radius.mul(tower).max(thickness.mul(leastTower).min(radius)).toConst()
    const base = mix(radius, narrow, anvilShare).toConst() as Float
    const wide = mix(base, radius, anvilShare.mul(smoothstep(...anvilFrom, aspect))).toConst()
    const [atBase, atTop] = [0, 1].map(end => mix(float(narrowing[end]), widening[end], anvilShare))
    const column = base.mul(mix(atBase, atTop, height)).toConst() as Float
    const overDome = y.sub(tall.mul(dome).sub(column).max(0)).max(0).toConst()
    const inTower = column
      .sub(towerDistance.mul(towerDistance).add(overDome.mul(overDome)).sqrt())
      .toConst()
    const rise = y.sub(tall.mul(anvil)).toConst() as Float
    const depth = tall.mul(select(rise.greaterThan(0), float(above), float(below))).toConst()
    // Distance from an ellipsoid, to first order.
    const [across, up] = [distance.div(wide).toConst(), rise.div(depth).toConst()]
    const norm = across.mul(across).add(up.mul(up)).sqrt().toConst()
    const slope = across.div(wide)
    const steep = up.div(depth)
    const gradient = slope.mul(slope).add(steep.mul(steep)).sqrt().max(1e-6)
    const inAnvil = norm.oneMinus().mul(norm.div(gradient)).toConst() as Float
    const soft = tall.mul(blend).toConst() as Float
    const share = inTower.sub(inAnvil).div(soft).mul(0.5).add(0.5).clamp().toConst() as Float
    return mix(inAnvil, inTower, share).add(soft.mul(share).mul(share.oneMinus()))
  },
  layout('welkinStormBody', 'float', {
    distance: 'float',
    towerDistance: 'float',
    radius: 'float',
    height: 'float',
    thickness: 'float',
    anvilShare: 'float'
  })
) as unknown as (
  distance: Float,
  towerDistance: Float,
  radius: Float,
  height: Float,
  thickness: Float,
  anvilShare: Float
) => Float
