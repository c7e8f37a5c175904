import {
  BufferAttribute,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedBufferGeometry
} from 'three'

/** Names of the attributes of an instance, four numbers each. */
export const INSTANCE_ATTRIBUTES = ['tileBase', 'tileOffset', 'tileCube', 'tilePage'] as const

/**
 * Grid that all tiles share, with a skirt about it, and room for tiles as instances.
 *
 * Its `position` is the column and row of a vertex, and 1 in z for those of the skirt.
 *
 * @param resolution - Cells along an edge, even.
 * @param capacity - Number of tiles that there is room for.
 */
export function tileGrid(resolution: number, capacity: number): InstancedBufferGeometry {
  const side = resolution + 1
  const positions: number[] = []
  const indices: number[] = []
  for (let y = 0; y < side; y++) for (let x = 0; x < side; x++) positions.push(x, y, 0)
  // Columns by eight: a vertex is still in the cache when the next row needs it.
  for (let left = 0; left < resolution; left += 8) {
    const right = Math.min(left + 8, resolution)
    for (let y = 0; y < resolution; y++) {
      for (let x = left; x < right; x++) {
        const i = y * side + x
        // One diagonal for all: morphed to half the resolution it is the same one.
        indices.push(i, i + 1, i + side + 1, i, i + side + 1, i + side)
      }
    }
  }
  // Once about the tile: each corner begins a side, which goes on by a step.
  const first = side * side
  const edge = [
    [0, 1],
    [resolution, side],
    [first - 1, -1],
    [first - side, -side]
  ].flatMap(([corner, step]) => Array.from({ length: resolution }, (_, i) => corner + i * step))
  for (const [n, i] of edge.entries()) {
    positions.push(positions[3 * i], positions[3 * i + 1], 1)
    const m = (n + 1) % edge.length
    indices.push(edge[n], first + n, first + m, edge[n], first + m, edge[m])
  }
  const geometry = new InstancedBufferGeometry()
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3))
  geometry.setIndex(new BufferAttribute(new Uint32Array(indices), 1))
  for (const name of INSTANCE_ATTRIBUTES) {
    const attribute = new InstancedBufferAttribute(new Float32Array(4 * capacity), 4)
    geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage))
  }
  geometry.instanceCount = 0
  return geometry
}
