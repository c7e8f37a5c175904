/** Cells of a sphere: rings of equal area about the axis towards the light, and equal parts of the way along it. */
export const RINGS = 10
export const STEPS = 16

/** Marsaglia's xorshift with 32 bits, uniform in (0, 1): the same numbers in every run. */
function randomNumbers(): () => number {
  let state = 0x9e37_79b9
  return () => {
    state ^= state << 13
    state ^= state >>> 17
    state ^= state << 5
    return ((state >>> 0) + 0.5) / 2 ** 32
  }
}

/** Light that was scattered before, in the cells of a sphere: by ring from the axis outwards, then by part of the way from the side of the light. */
export interface SphereLight {
  /** Mean radiance [1/sr]. */
  source: number[]
  /** Mean over directions of radiance times the cosine to the way of the beam, and times that cosine's second Legendre polynomial [1/sr]. */
  along: number[]
  square: number[]
  /** Mean over directions of radiance times the cosine to the direction away from the axis [1/sr]. */
  aside: number[]
}

/**
 * Light that was scattered before in the cells of a homogeneous sphere that
 * does not absorb, in a beam of unit irradiance.
 *
 * Photons are traced and their collisions after the first one counted, by cell.
 *
 * @param diameter - Scaled optical diameter.
 * @param chi1 - χ′₁, and χ′₂ below: the phase function has no further terms.
 */
export function sphereLight(
  diameter: number,
  chi1: number,
  chi2: number,
  photons: number
): SphereLight {
  const random = randomNumbers()
  const radius = diameter / 2
  const phase = (mu: number): number => 1 + 3 * chi1 * mu + 2.5 * chi2 * (3 * mu * mu - 1)
  const samples = Array.from({ length: 2000 }, (_, i) => Math.abs(phase(-1 + (i + 0.5) / 1000)))
  const highest = 1.001 * Math.max(...samples)
  const magnitude = samples.reduce((sum, value) => sum + value, 0) / samples.length
  const [source, along, square, aside] = Array.from({ length: 4 }, () =>
    Array.from({ length: RINGS * STEPS }, () => 0)
  )
  for (let photon = 0; photon < photons; photon++) {
    let x = radius * Math.sqrt(random())
    let y = 0
    let z = Math.sqrt(radius * radius - x * x)
    let [dx, dy, dz] = [0, 0, -1]
    let weight = 1
    for (let order = 0; ; order++) {
      const step = -Math.log(random())
      x += dx * step
      y += dy * step
      z += dz * step
      const fromAxis = x * x + y * y
      if (fromAxis + z * z >= radius * radius) break
      if (order > 0) {
        const half = Math.sqrt(radius * radius - fromAxis)
        const ring = Math.min(Math.floor((fromAxis / radius ** 2) * RINGS), RINGS - 1)
        const part = Math.min(Math.floor(((half - z) / (2 * half)) * STEPS), STEPS - 1)
        const cell = ring * STEPS + part
        source[cell] += weight
        along[cell] -= weight * dz
        square[cell] += weight * (1.5 * dz * dz - 0.5)
        aside[cell] += (weight * (dx * x + dy * y)) / Math.sqrt(Math.max(fromAxis, 1e-12))
      }
      let cosine: number
      do cosine = 2 * random() - 1
      while (random() * highest > Math.abs(phase(cosine)))
      if (phase(cosine) < 0) weight = -weight
      weight *= magnitude
      const turn = 2 * Math.PI * random()
      const sine = Math.sqrt(1 - cosine * cosine)
      const [u, v] = [sine * Math.cos(turn), sine * Math.sin(turn)]
      // Frisvad's frame, about the axis that the direction is not near.
      const sign = dz < 0 ? -1 : 1
      const a = -1 / (sign + dz)
      const b = dx * dy * a
      ;[dx, dy, dz] = [
        u * (1 + sign * dx * dx * a) + v * b + cosine * dx,
        u * sign * b + v * (sign + dy * dy * a) + cosine * dy,
        -u * sign * dx - v * dy + cosine * dz
      ]
    }
  }
  const perVolume = (count: number, i: number): number => {
    const inner = 1 - Math.floor(i / STEPS) / RINGS
    const outer = inner - 1 / RINGS
    const sphere = (4 / 3) * Math.PI * radius ** 3
    const volume = (sphere * (inner ** 1.5 - Math.max(outer, 0) ** 1.5)) / STEPS
    return (count * Math.PI * radius ** 2) / (photons * volume * 4 * Math.PI)
  }
  const [a, b, c, d] = [source, along, square, aside].map(counts => counts.map(perVolume))
  return { source: a, along: b, square: c, aside: d }
}
