import { MathUtils, Vector3 } from 'three'
import { billowForm } from '../../src/density/formConstants'
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
import { layerPeriods } from '../../src/layers/layerUniforms'
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

/** Storms around a place, as displacements to them [cells]. */
interface StormGaps {
  readonly anvil: Vector3
  readonly tower: Vector3
  /** Distance from the next nearest anvil of those that are searched, less that from the nearest. */
  readonly lead: number
  /** Distance from the axis of the next nearest tower, less that from the nearest. */
  readonly towerLead: number
}

/** A storm in a cell around a place. */
interface StormInCell {
  /** Displacement to it [cells]. */
  readonly gap: Vector3
  /** True in the eight cells that the shader looks at: none beyond the farther side of the place's own. */
  readonly isSearched: boolean
}

/** Storms in all cells around a place in the lattice [periods]. */
function stormsAround(place: Vec3Array): StormInCell[] {
  const { cells, seed, jitter } = stormPlaces
  const at = new Vector3(...place).multiplyScalar(cells)
  const base = at.clone().floor()
  const part = at.clone().sub(base).subScalar(0.5).toArray()
  return Array.from({ length: 27 }, (_, corner) => {
    const steps = [corner % 3, Math.floor(corner / 3) % 3, Math.floor(corner / 9)].map(n => n - 1)
    const [i, j, k] = steps.map((step, axis) => base.getComponent(axis) + step)
    const [x, y, z] = [i, j, k].map(n => wrap(n, cells))
    const gap = hashCell(x, y, z + seed)
      .subScalar(0.5)
      .multiplyScalar(jitter)
      .add(new Vector3(i + 0.5, j + 0.5, k + 0.5))
      .sub(at)
    return { gap, isSearched: steps.every((step, axis) => step * part[axis] >= 0) }
  })
}

/**
 * Float64 twin of `stormGaps`, over all cells around, of which the shader looks at the nearest eight.
 *
 * @param place - Place in the lattice, in its periods.
 * @param up - Zenith in the lattice.
 * @param downwind - Displacement of a storm's anvil from its tower [cells].
 */
export function stormGaps(place: Vec3Array, up: Vector3, downwind: Vector3): StormGaps {
  const storms = stormsAround(place)
  const byDistance = (gaps: Vector3[]): Vector3[] =>
    gaps.toSorted((a, b) => axisDistance(a, up) - axisDistance(b, up))
  const [anvil] = byDistance(storms.map(({ gap }) => gap))
  const [tower] = byDistance(storms.map(({ gap }) => gap.clone().sub(downwind)))
  const searched = storms.filter(({ isSearched }) => isSearched).map(({ gap }) => gap)
  const leadOf = (gaps: Vector3[]): number => {
    const [first, second] = byDistance(gaps).map(gap => axisDistance(gap, up))
    return second - first
  }
  return {
    anvil,
    tower,
    lead: leadOf(searched),
    towerLead: leadOf(searched.map(gap => gap.clone().sub(downwind)))
  }
}

/** A storm around a place: see `StormAround` of density/tsl/storm.ts. */
export interface StormAround {
  readonly distance: number
  readonly towerDistance: number
  readonly rank: number
  /** Place in the noise that makes fibres, for the layer's base, and the zenith there [periods]. */
  readonly fibrePlace: Vector3
  readonly zenith: Vector3
  /** Share of fibres, in [0, 1]: none midway between two storms. */
  readonly fibreShare: number
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
  const found = stormGaps(still, up, aside)
  const bend = new Vector3(...place).sub(new Vector3(...still)).multiplyScalar(stormPlaces.cells)
  const unit = layer.turbulence * billowForm.bend * layerPeriods(layer).shape
  const bent = (gap: Vector3, lead: number): Vector3 => {
    const share = (lead * stormCell(layer)) / Math.max(unit * stormShape.steady, 1)
    return gap.clone().addScaledVector(bend, -MathUtils.clamp(share, 0, 1))
  }
  const anvil = bent(found.anvil, found.lead)
  const tower = bent(found.tower, found.towerLead)
  const { merge } = stormPlaces
  const merged = (merge / 4) * Math.max(1 - found.lead / merge, 0) ** 2
  const cells = Math.max(axisDistance(anvil, up) - merged, 0)
  const { scale, power } = stormPlaces
  const towerDistance = axisDistance(tower, up) * stormCell(layer)
  const axis = new Vector3(...still).multiplyScalar(stormPlaces.cells).add(found.anvil)
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
    fibreShare: MathUtils.clamp(
      (found.lead * stormCell(layer)) / Math.max(radius * stormFibres.lead, 1),
      0,
      1
    ),
    zenith: up,
    rank: Math.exp(-(Math.max(cells / scale, 1e-4) ** power))
  }
}

/** A storm around a place, and the radius that it has there [m]. */
export interface StormThere extends StormAround {
  readonly radius: number
}

/** Level of detail at which fibres are looked up, by that of billows: their own period is another. */
export function fibreLevel(layer: CloudLayerParameters, radius: number, level: number): number {
  const { around, upwards, sharper } = stormFibres
  const period = Math.min(radius / around, upwards) / layerPeriods(layer).shape
  return Math.max(level - Math.log2(period) - sharper, 0)
}

/**
 * Float64 twin of `frayedDistance` [m].
 *
 * @param billowsAt - Coarse and fine billows at a place in their noise [periods], of unit deviation.
 */
export function frayedDistance(
  layer: CloudLayerParameters,
  { distance, towerDistance, radius, fibrePlace, fibreShare, zenith }: StormThere,
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
  return distance - MathUtils.clamp(fray * fibres, -mostFray, mostFray) * ice * fibreShare * radius
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
    crumbs: stormDensity(layer, height, ice, 2 * distance - unfrayed, radius, towerDistance)
  }
}
