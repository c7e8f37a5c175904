import { Vector3 } from 'three'
import { stormBillows, stormPlaces } from '../../src/density/stormForm'
import type { CloudLayerParameters } from '../../src/layers/CloudLayer'
import { smoothStormStrength, stormEdge, stormRoughness } from '../../src/layers/meanColumn'
import { stormCell } from '../../src/layers/storms'
import { hashCell, type Vec3Array } from './noise'

const wrap = (i: number, cells: number): number => ((i % cells) + cells) % cells

/**
 * Float64 twin of `stormDistance`, over all cells around, of which the shader looks at the nearest eight [cells].
 *
 * @param place - Place in the lattice, in its periods.
 * @param up - Zenith in the lattice.
 */
export function stormDistance(place: Vec3Array, up: Vector3): number {
  const { cells, seed, jitter, away } = stormPlaces
  const at = new Vector3(...place).multiplyScalar(cells)
  const base = at.clone().floor()
  let nearest = Infinity
  for (let corner = 0; corner < 27; corner++) {
    const [i, j, k] = [corner % 3, Math.floor(corner / 3) % 3, Math.floor(corner / 9)].map(
      (digit, axis) => base.getComponent(axis) + digit - 1
    )
    const [x, y, z] = [i, j, k].map(n => wrap(n, cells))
    const gap = hashCell(x, y, z + seed)
      .subScalar(0.5)
      .multiplyScalar(jitter)
      .add(new Vector3(i + 0.5, j + 0.5, k + 0.5))
      .sub(at)
    const height = gap.dot(up)
    const across = gap.clone().addScaledVector(up, -height)
    nearest = Math.min(nearest, Math.hypot(across.length(), Math.sqrt(away) * height ** 3))
  }
  return nearest
}

/** Float64 twin of `stormAround`: distance from the axis of the nearest storm [m], and its rank. */
export function stormAround(
  layer: CloudLayerParameters,
  place: Vec3Array,
  up: Vector3
): { distance: number; rank: number } {
  const cells = stormDistance(place, up)
  const { scale, power } = stormPlaces
  return {
    distance: cells * stormCell(layer),
    rank: Math.exp(-(Math.max(cells / scale, 1e-4) ** power))
  }
}

/** Float64 twin of `stormStrength`. */
export function stormStrength(
  layer: CloudLayerParameters,
  { distance, radius }: { distance: number; radius: number },
  coarse: number,
  fine: number,
  height: number
): { body: number; strength: number; detail: number; edge: number; crumbs: number } {
  const amount = stormRoughness(layer, height)
  const body =
    smoothStormStrength(layer, distance, radius, height) + amount * stormBillows.coarse * coarse
  return {
    body,
    strength: body + amount * stormBillows.fine * fine,
    detail: amount * layer.detailAmount * stormBillows.detail,
    edge: stormEdge(layer, height),
    crumbs: 1
  }
}
