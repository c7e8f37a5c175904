import { BufferGeometry, Float32BufferAttribute } from 'three'

const SECTORS = 96
/** Radius of the innermost ring [m], and the factor from ring to ring. */
const FIRST_RING = 4
const GROWTH = 1.12

/**
 * Sphere whose triangles are small about its top, which is the origin, and grow with distance from there.
 *
 * @param radius - Radius of the sphere [m].
 */
export function planetGeometry(radius: number): BufferGeometry {
  const angles: number[] = []
  for (let arc = FIRST_RING; arc < 3 * radius; arc *= GROWTH) angles.push(arc / radius)
  angles.push(Math.PI)
  const positions = [0, 0, 0]
  const normals = [0, 1, 0]
  const indices: number[] = []
  angles.forEach((angle, ring) => {
    for (let i = 0; i < SECTORS; i++) {
      const turn = (2 * Math.PI * i) / SECTORS
      const x = Math.sin(angle) * Math.cos(turn)
      const z = Math.sin(angle) * Math.sin(turn)
      // 1 − cos, without its cancellation.
      positions.push(radius * x, -2 * radius * Math.sin(angle / 2) ** 2, radius * z)
      normals.push(x, Math.cos(angle), z)
      const next = (i + 1) % SECTORS
      const [a, b] = [1 + ring * SECTORS + i, 1 + ring * SECTORS + next]
      if (ring === 0) indices.push(0, b, a)
      else indices.push(a - SECTORS, b, a, a - SECTORS, b - SECTORS, b)
    }
  })
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3))
  geometry.setAttribute('normal', new Float32BufferAttribute(normals, 3))
  geometry.setIndex(indices)
  return geometry
}
