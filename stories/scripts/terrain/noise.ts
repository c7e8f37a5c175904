function lattice(x: number, y: number): number {
  let hash = Math.imul(x, 0x27d4eb2d) ^ Math.imul(y, 0x165667b1)
  hash = Math.imul(hash ^ (hash >>> 15), 0x2c1b3c6d)
  hash = Math.imul(hash ^ (hash >>> 12), 0x297a2d39)
  return ((hash ^ (hash >>> 15)) >>> 0) / 4294967296
}

/** Value noise in [0, 1]: smooth between random values on the integers. */
export function noise(x: number, y: number): number {
  const x0 = Math.floor(x)
  const y0 = Math.floor(y)
  const fx = x - x0
  const fy = y - y0
  const u = fx * fx * (3 - 2 * fx)
  const v = fy * fy * (3 - 2 * fy)
  const top = lattice(x0, y0) * (1 - u) + lattice(x0 + 1, y0) * u
  const bottom = lattice(x0, y0 + 1) * (1 - u) + lattice(x0 + 1, y0 + 1) * u
  return top * (1 - v) + bottom * v
}

/** Sum of octaves of `noise`, each at twice the frequency and half the weight; in [0, 1]. */
export function fractalNoise(x: number, y: number, octaves: number): number {
  let sum = 0
  let weight = 1
  let total = 0
  for (let octave = 0; octave < octaves; octave++) {
    const scale = 2 ** octave
    sum += noise(x * scale + octave * 17, y * scale + octave * 31) * weight
    total += weight
    weight /= 2
  }
  return sum / total
}
