/** Pseudo-random number of a point of whole numbers, in [0, 1). */
export function hashed(x: number, z: number, seed: number): number {
  let bits = Math.imul(x, 0x27d4eb2d) ^ Math.imul(z, 0x165667b1) ^ Math.imul(seed, 0x9e3779b1)
  bits = Math.imul(bits ^ (bits >>> 15), 0x85ebca6b)
  bits = Math.imul(bits ^ (bits >>> 13), 0xc2b2ae35)
  return ((bits ^ (bits >>> 16)) >>> 0) / 2 ** 32
}

const fade = (t: number): number => t * t * (3 - 2 * t)

/** Smooth noise of two dimensions between random numbers at whole ones, in [0, 1). */
export function valueNoise(x: number, z: number, seed: number): number {
  const [i, j] = [Math.floor(x), Math.floor(z)]
  const [s, t] = [fade(x - i), fade(z - j)]
  const row = (n: number): number => (1 - s) * hashed(i, n, seed) + s * hashed(i + 1, n, seed)
  return (1 - t) * row(j) + t * row(j + 1)
}
