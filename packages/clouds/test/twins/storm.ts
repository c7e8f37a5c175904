import { MathUtils, Vector3 } from 'three'
import { stormBillows, stormFibres, stormPlaces, stormShape } from '../../src/density/stormForm'
import type { CloudLayerParameters } from '../../src/layers/CloudLayer'
import {
  iceAround,
  smoothStormStrength,
  stormDensity,
  stormEdge,
  stormNearness,
  stormRoughness
} from '../../src/layers/meanColumn'
import { stormCell } from '../../src/layers/storms'
import { hashCell, type Vec3Array } from './noise'

const wrap = (i: number, cells: number): number => ((i % cells) + cells) % cells

/** Distance of a storm's tower from the middle of its anvil, upwind [m]. */
export function stormAside(
  { baseAltitude, topAltitude, anvil, shear }: CloudLayerParameters,
  radius: number
): number {
  const { aside, mostAside, anvilFrom } = stormShape
  const grown = MathUtils.smoothstep(radius / (topAltitude - baseAltitude), ...anvilFrom)
  return Math.min(aside * Math.abs(shear), mostAside) * anvil * grown * radius
}

/** Distance from a storm's axis [cells]. */
function axisDistance(gap: Vector3, up: Vector3): number {
  const height = gap.dot(up)
  const across = gap.clone().addScaledVector(up, -height)
  return Math.hypot(across.length(), Math.sqrt(stormPlaces.away) * height ** 3)
}

/**
 * Float64 twin of `stormGaps`, over all cells around, of which the shader looks at the nearest eight [cells].
 *
 * @param place - Place in the lattice, in its periods.
 * @param up - Zenith in the lattice.
 * @param downwind - Displacement of a storm's anvil from its tower [cells].
 * @returns Displacements to the axes of the nearest anvil and of the nearest tower.
 */
export function stormGaps(
  place: Vec3Array,
  up: Vector3,
  downwind: Vector3
): { anvil: Vector3; tower: Vector3 } {
  const { cells, seed, jitter } = stormPlaces
  const at = new Vector3(...place).multiplyScalar(cells)
  const base = at.clone().floor()
  const gaps = Array.from({ length: 27 }, (_, corner) => {
    const [i, j, k] = [corner % 3, Math.floor(corner / 3) % 3, Math.floor(corner / 9)].map(
      (digit, axis) => base.getComponent(axis) + digit - 1
    )
    const [x, y, z] = [i, j, k].map(n => wrap(n, cells))
    return hashCell(x, y, z + seed)
      .subScalar(0.5)
      .multiplyScalar(jitter)
      .add(new Vector3(i + 0.5, j + 0.5, k + 0.5))
      .sub(at)
  })
  const nearest = (all: Vector3[]): Vector3 =>
    all.reduce((best, gap) => (axisDistance(gap, up) < axisDistance(best, up) ? gap : best))
  return { anvil: nearest(gaps), tower: nearest(gaps.map(gap => gap.clone().sub(downwind))) }
}

/** A storm around a place: see `StormAround` of density/tsl/storm.ts. */
export interface StormAround {
  readonly distance: number
  readonly towerDistance: number
  readonly rank: number
  /** Place in the noise that makes fibres, for the layer's base, and the zenith there [periods]. */
  readonly fibrePlace: Vector3
  readonly zenith: Vector3
}

/**
 * Float64 twin of `stormAround`: distances from the axes of the nearest anvil and of the nearest tower [m], and the
 * anvil's rank.
 *
 * @param downwind - Direction that columns lean to, in the lattice, of any length.
 * @param still - The place without turbulence, where the nearest are looked for.
 */
export function stormAround(
  layer: CloudLayerParameters,
  place: Vec3Array,
  up: Vector3,
  downwind = new Vector3(),
  radius = 0,
  still = place
): StormAround {
  const aside = downwind.clone().setLength(stormAside(layer, radius) / stormCell(layer))
  const turned = still.map((value, axis) => (value - place[axis]) * stormPlaces.cells)
  const found = stormGaps(still, up, aside)
  const [anvil, tower] = [found.anvil, found.tower].map(gap => gap.add(new Vector3(...turned)))
  const cells = axisDistance(anvil, up)
  const { scale, power } = stormPlaces
  const towerDistance = axisDistance(tower, up) * stormCell(layer)
  const axis = new Vector3(...place).multiplyScalar(stormPlaces.cells).add(anvil)
  const outward = aside.clone().sub(anvil).projectOnPlane(up)
  const fibrePlace = outward
    .clone()
    .setLength(stormFibres.around * Math.min(outward.length() / stormFibres.core, 1))
    .add(axis)
    .addScaledVector(up, (outward.length() * stormCell(layer)) / stormFibres.outwards)
  return {
    distance: cells * stormCell(layer),
    towerDistance,
    fibrePlace,
    zenith: up,
    rank: Math.exp(-(Math.max(cells / scale, 1e-4) ** power))
  }
}

/** A storm around a place, and the radius that it has there [m]. */
export interface StormThere extends StormAround {
  readonly radius: number
}

/**
 * Float64 twin of `frayedDistance` [m].
 *
 * @param billowsAt - Coarse and fine billows at a place in their noise [periods], of unit deviation.
 */
export function frayedDistance(
  layer: CloudLayerParameters,
  { distance, towerDistance, radius, fibrePlace, zenith }: StormThere,
  height: number,
  billowsAt: (place: Vec3Array) => readonly number[]
): number {
  const { upwards, weights, fray, mostFray, rim } = stormFibres
  const ice = iceAround(layer, height, towerDistance, radius)
  const inRadii = distance / Math.max(radius, 1)
  if (ice === 0 || inRadii <= rim[0] || inRadii >= rim[1]) return distance
  const rise = height * (layer.topAltitude - layer.baseAltitude)
  const place = fibrePlace.clone().addScaledVector(zenith, rise / upwards)
  const [coarse, fine] = billowsAt(place.toArray())
  const fibres = weights[0] * coarse + weights[1] * fine
  return distance - MathUtils.clamp(fray * fibres, -mostFray, mostFray) * ice * radius
}

/** Float64 twin of `stormStrength`. */
export function stormStrength(
  layer: CloudLayerParameters,
  {
    distance,
    towerDistance,
    radius,
    unfrayed = distance
  }: { distance: number; towerDistance: number; radius: number; unfrayed?: number },
  coarse: number,
  fine: number,
  height: number
): {
  strength: number
  detail: number
  edge: number
  crumbs: number
} {
  const ice = iceAround(layer, height, towerDistance, radius)
  const amount = stormRoughness(layer, ice)
  const smooth = smoothStormStrength(layer, distance, radius, height, towerDistance)
  const body = smooth + amount * stormNearness(smooth) * stormBillows.coarse * coarse
  return {
    strength: body + amount * stormBillows.fine * fine,
    detail: amount * layer.detailAmount * stormBillows.detail,
    edge: stormEdge(layer, ice),
    crumbs: stormDensity(layer, height, ice, 2 * distance - unfrayed, radius)
  }
}
