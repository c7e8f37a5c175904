import { Float32BufferAttribute, InstancedBufferGeometry } from 'three'
import type { InstancedBufferAttribute } from 'three'
import { CHUNK } from './FallingChunks'

/** Chunk of quads: corners in [−1, 1]², and the quad's number. @param chunks - Attribute of instances, by `FallingChunks`. */
export function chunkGeometry(chunks: InstancedBufferAttribute): InstancedBufferGeometry {
  const geometry = new InstancedBufferGeometry()
  const corners: number[] = []
  const index: number[] = []
  for (let i = 0; i < CHUNK; i++) {
    corners.push(-1, -1, i, 1, -1, i, -1, 1, i, 1, 1, i)
    index.push(...[0, 1, 2, 2, 1, 3].map(n => 4 * i + n))
  }
  geometry.setAttribute('position', new Float32BufferAttribute(corners, 3))
  geometry.setAttribute('chunk', chunks)
  geometry.setIndex(index)
  return geometry
}
