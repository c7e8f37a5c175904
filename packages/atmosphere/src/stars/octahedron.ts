const fold = (a: number, b: number): number => (a < 0 ? -1 : 1) * (1 - Math.abs(b))

/**
 * Direction, not of unit length, of a point on the map of directions that is the net of an octahedron.
 *
 * @param x - In [−1, 1].
 * @param y - In [−1, 1].
 */
export function octahedralDirection(x: number, y: number): [number, number, number] {
  const z = 1 - Math.abs(x) - Math.abs(y)
  return z < 0 ? [fold(x, y), fold(y, x), z] : [x, y, z]
}

/** Where a direction of any length is on that map; each in [−1, 1]. */
export function octahedralPoint([x, y, z]: readonly number[]): [number, number] {
  const size = Math.abs(x) + Math.abs(y) + Math.abs(z)
  const [u, v] = [x / size, y / size]
  return z < 0 ? [fold(u, v), fold(v, u)] : [u, v]
}
