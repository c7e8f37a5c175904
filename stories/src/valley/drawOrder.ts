import { BufferAttribute, type Mesh, type Vector3 } from 'three'

/** Quads across a strip of a tile: in whole rows, most vertices would be found twice. */
const ACROSS = 4

/** Ways to go through a tile: along which axis strips follow each other, and whether towards its end. */
const ORDERS = [
  { isAlongZ: true, isForwards: true },
  { isAlongZ: true, isForwards: false },
  { isAlongZ: false, isForwards: true },
  { isAlongZ: false, isForwards: false }
] as const

/**
 * Triangles of a tile once in each order, for all tiles to share: `drawFromNear` chooses one.
 *
 * @param size - Quads along a side; vertices are in rows along x, as those of three's planes.
 */
export function tileIndex(size: number): BufferAttribute {
  const corners: number[] = []
  for (const { isAlongZ, isForwards } of ORDERS) {
    for (let i = 0; i < size * size; i++) {
      const strip = Math.floor(i / (ACROSS * size))
      const [along, across] = [Math.floor(i / ACROSS) % size, ACROSS * strip + (i % ACROSS)]
      const outer = isForwards ? across : size - 1 - across
      const [x, z] = isAlongZ ? [along, outer] : [outer, along]
      const above = z * (size + 1) + x
      const below = above + size + 1
      corners.push(above, below, above + 1, below, below + 1, above + 1)
    }
  }
  return new BufferAttribute(new Uint16Array(corners), 1)
}

/** Has a tile drawn from what is near a camera to what is far, so that its hills hide what is behind them. */
export function drawFromNear({ geometry, position }: Mesh, camera: Vector3): void {
  const [x, z] = [camera.x - position.x, camera.z - position.z]
  const isAlongZ = Math.abs(z) > Math.abs(x)
  const isForwards = (isAlongZ ? z : x) < 0
  const order = ORDERS.findIndex(
    each => each.isAlongZ === isAlongZ && each.isForwards === isForwards
  )
  const count = geometry.index!.count / ORDERS.length
  geometry.setDrawRange(order * count, count)
}
