/** Coordinate folded across an edge of the map, where the octahedron's lower faces are. */
const fold = (a: number, b: number): number => (a < 0 ? -1 : 1) * (1 - Math.abs(b))

/**
 * Direction of a point of the octahedral map, not of unit length.
 *
 * @param x - In [−1, 1].
 * @param y - In [−1, 1].
 * @see Cigolle et al. 2014, "A survey of efficient representations for independent unit vectors", "oct".
 *   Twin of tsl/octahedron.ts, which gives unit vectors
 */
export function octahedralDirection(x: number, y: number): [number, number, number] {
  const z = 1 - Math.abs(x) - Math.abs(y)
  return z < 0 ? [fold(x, y), fold(y, x), z] : [x, y, z]
}

/** Point of the octahedral map in [−1, 1]² for a direction of any length. */
export function octahedralPoint([x, y, z]: readonly number[]): [number, number] {
  const size = Math.abs(x) + Math.abs(y) + Math.abs(z)
  const [u, v] = [x / size, y / size]
  return z < 0 ? [fold(u, v), fold(v, u)] : [u, v]
}
