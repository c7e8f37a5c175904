/** Fog with a density that falls off exponentially with altitude. */
export interface FogLayer {
  /** Extinction at the base [1/m]. */
  density: number
  /** Altitude over which the density falls to 1/e [m]. */
  falloff: number
  /** Altitude of the base above the ground [m]. */
  base: number
}

/** e^{x²} erfc x for x ≥ 0: the continued fraction, and near 0 a Taylor series of erf. */
export function erfcx(x: number): number {
  if (x > 2) {
    let fraction = 0
    for (let k = 80; k > 0; k--) fraction = k / 2 / (x + fraction)
    return 1 / (Math.sqrt(Math.PI) * (x + fraction))
  }
  let [term, sum] = [x, x]
  for (let n = 1; n < 60; n++) {
    term *= (-x * x) / n
    sum += term / (2 * n + 1)
  }
  return Math.exp(x * x) * (1 - (2 / Math.sqrt(Math.PI)) * sum)
}

/**
 * Optical depth of fog along a ray in closed form: from the point of the ray's line that is nearest to
 * the planet the altitude grows as s²/2r, so the depth is a difference of error functions. Each is taken
 * with the altitude and the slope of its own end, which is right for steep rays as well.
 *
 * @param radius - Planet's centre to the start of the ray [m].
 * @param cosView - μ at the start.
 * @param bottomRadius - Planet's centre to the ground [m].
 * @param distance - Length of the ray [m].
 */
export function fogDepth(
  { density, falloff, base }: FogLayer,
  radius: number,
  cosView: number,
  bottomRadius: number,
  distance: number
): number {
  const nearest = radius * Math.sqrt(1 - cosView ** 2)
  const from = radius * cosView
  const to = from + distance
  /** Fog from the line's nearest point to s, as the fog of half of the line less what is beyond s. */
  const half = (s: number): number => {
    const r = Math.hypot(nearest, s)
    const at = (q: number, z: number): number =>
      Math.exp(-(q - bottomRadius - base) / falloff) *
      Math.sqrt((Math.PI * q * falloff) / 2) *
      erfcx(z)
    const beyond = at(r, Math.sqrt(r / (2 * falloff)) * (Math.abs(s) / r))
    return Math.sign(s) * (at(nearest, 0) - beyond)
  }
  // Both ends on a side: what the nearest point has, deep in the planet, must not drown the difference.
  if (from * to > 0) {
    const outward = (s: number): number => {
      const r = Math.hypot(nearest, s)
      return (
        Math.exp(-(r - bottomRadius - base) / falloff) *
        Math.sqrt((Math.PI * r * falloff) / 2) *
        erfcx(Math.sqrt(r / (2 * falloff)) * (Math.abs(s) / r))
      )
    }
    return density * Math.abs(outward(from) - outward(to))
  }
  return density * (half(to) - half(from))
}

/**
 * Mean radiance of sunlight scattered more than once in a plane layer that absorbs nothing, over black
 * ground, for unit irradiance [1/sr]: Eddington's equation I″ = −(3/4π) e^{−τ/μ}, solved as the
 * particular solution and a straight line that meets both boundaries.
 *
 * @param above - Vertical depth above the point, scaled by 1 − g.
 * @param whole - Vertical depth of the layer, likewise.
 * @param cosLight - μ > 0.
 */
export function multipleScattering(above: number, whole: number, cosLight: number): number {
  const e = 1 / (4 * Math.PI)
  const particular = (depth: number): number => -3 * cosLight ** 2 * e * Math.exp(-depth / cosLight)
  const particularSlope = (depth: number): number => 3 * cosLight * e * Math.exp(-depth / cosLight)
  // I − ⅔ I′ = 0 at the top, I + ⅔ I′ = 0 at the bottom, for I = a + b τ + particular.
  const top = -(particular(0) - (2 / 3) * particularSlope(0))
  const bottom = -(particular(whole) + (2 / 3) * particularSlope(whole))
  const b = (bottom - top) / (whole + 4 / 3)
  const a = top + (2 / 3) * b
  return Math.max(a + b * above + particular(above), 0)
}
