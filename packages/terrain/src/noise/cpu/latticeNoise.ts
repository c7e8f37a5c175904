/** Gradient per wavelength and value of noise. */
export interface Noise {
  /** Gradient along X, per wavelength. */
  x: number
  /** Gradient along Y. */
  y: number
  /** Gradient along Z. */
  z: number
  /** About ±0.6, at most ±1.5. */
  value: number
}

/** Gradient of a cell: twin of the shader's, bit for bit. Three components in [−1, 1). */
export function latticeGradient(x: number, y: number, z: number, target: number[]): number[] {
  let a = (Math.imul(x, 1664525) + 1013904223) | 0
  let b = (Math.imul(y, 1664525) + 1013904223) | 0
  let c = (Math.imul(z, 1664525) + 1013904223) | 0
  a = (a + Math.imul(b, c)) | 0
  b = (b + Math.imul(c, a)) | 0
  c = (c + Math.imul(a, b)) | 0
  a ^= a >>> 16
  b ^= b >>> 16
  c ^= c >>> 16
  a = (a + Math.imul(b, c)) | 0
  b = (b + Math.imul(c, a)) | 0
  c = (c + Math.imul(a, b)) | 0
  target[0] = (a >>> 9) / 2 ** 22 - 1
  target[1] = (b >>> 9) / 2 ** 22 - 1
  target[2] = (c >>> 9) / 2 ** 22 - 1
  return target
}

const corner = [0, 0, 0]

/**
 * Float64 twin of the shader function `latticeNoise`, at a position instead of a reference and an offset.
 *
 * @param x - ECEF [m], like `y` and `z`; below 2³⁰ wavelengths.
 * @param inverse - 1 / wavelength, a power of two [1/m].
 * @param seed - Whole number ≥ 0: another one, other noise.
 */
export function latticeNoise(
  x: number,
  y: number,
  z: number,
  inverse: number,
  seed: number,
  target: Noise
): Noise {
  const i = Math.floor(x * inverse)
  const j = Math.floor(y * inverse)
  const k = Math.floor(z * inverse)
  const px = x * inverse - i
  const py = y * inverse - j
  const pz = z * inverse - k
  const bx = px ** 3 * (px * (px * 6 - 15) + 10)
  const by = py ** 3 * (py * (py * 6 - 15) + 10)
  const bz = pz ** 3 * (pz * (pz * 6 - 15) + 10)
  const shiftX = (i + Math.imul(seed, 747796405)) | 0
  target.x = target.y = target.z = target.value = 0
  let slopeX = 0
  let slopeY = 0
  let slopeZ = 0
  for (let n = 0; n < 8; n++) {
    const cx = n & 1
    const cy = (n >> 1) & 1
    const cz = n >> 2
    const [gx, gy, gz] = latticeGradient(shiftX + cx, j + cy, k + cz + seed, corner)
    const value = gx * (px - cx) + gy * (py - cy) + gz * (pz - cz)
    const wx = cx === 1 ? bx : 1 - bx
    const wy = cy === 1 ? by : 1 - by
    const wz = cz === 1 ? bz : 1 - bz
    const weight = wx * wy * wz
    target.value += weight * value
    target.x += weight * gx
    target.y += weight * gy
    target.z += weight * gz
    slopeX += (2 * cx - 1) * wy * wz * value
    slopeY += (2 * cy - 1) * wx * wz * value
    slopeZ += (2 * cz - 1) * wx * wy * value
  }
  target.x += 30 * (px * (px - 1)) ** 2 * slopeX
  target.y += 30 * (py * (py - 1)) ** 2 * slopeY
  target.z += 30 * (pz * (pz - 1)) ** 2 * slopeZ
  return target
}
