import { Vector3 } from 'three'
import type { InstancedBufferAttribute, InstancedBufferGeometry } from 'three'
import type { Tile } from './Tile'
import { INSTANCE_ATTRIBUTES } from './tileGrid'

const point = new Vector3()

/**
 * Writes tiles as instances, from float64 to differences that float32 can hold. ECEF axes.
 *
 * @param position - Viewer [m].
 * @param reference - Point near the viewer's subpoint [m].
 * @param ground - Height of the ground below the viewer [m].
 * @param ranges - Distances at which levels end [m].
 */
export function writeTiles(
  geometry: InstancedBufferGeometry,
  tiles: readonly Tile[],
  position: Vector3,
  reference: Vector3,
  ground: number,
  ranges: readonly number[]
): void {
  const attributes = INSTANCE_ATTRIBUTES.map(
    name => geometry.getAttribute(name) as InstancedBufferAttribute
  )
  const [base, offset, cube, page] = attributes.map(attribute => attribute.array)
  let n = 0
  for (const tile of tiles) {
    const { center, normal, level, slot, parent } = tile
    point.copy(center).sub(position).addScaledVector(normal, ground).toArray(base, n)
    base[n + 3] = Math.min(ranges[level], 1e30)
    point.copy(center).sub(reference).toArray(offset, n)
    offset[n + 3] = tile.extent
    tile.cube.toArray(cube, n)
    cube[n + 3] = tile.face
    // Without a page of its own it is drawn with its parent's.
    const whole = parent?.slot ?? slot
    page[n] = slot < 0 ? whole : slot
    page[n + 1] = whole
    page[n + 2] = tile.quarter
    page[n + 3] = tile.fade
    n += 4
  }
  for (const attribute of attributes) {
    attribute.clearUpdateRanges()
    attribute.addUpdateRange(0, 4 * tiles.length)
    attribute.needsUpdate = true
  }
}
