import type { Spectrum } from '../../parameters/AtmosphereParameters'
import { gaussLegendre } from '../../math/cpu/quadrature'

const RULE = /*#__PURE__*/ gaussLegendre(16)

/**
 * Light of the corona over the sun's, all around it: what is left in totality.
 *
 * @see Allen 1976, §84: between 0.6e-6 and 1.3e-6 with the solar cycle
 */
export const CORONA = 1e-6

/**
 * Light of a limb-darkened disc out to a part of its radius, over all of it, and the disc itself per
 * area.
 */
const lightWithin = (part: number, u: number): number => {
  const cosine = Math.sqrt(Math.max(1 - part * part, 0))
  return ((1 - u) * part ** 2 + (2 / 3) * u * (1 - cosine ** 3)) / (1 - u / 3)
}

/**
 * Part of the sun's light that a round, dark disc in front of it takes away, in [0, 1].
 *
 * Rings of the sun that the disc covers in part are summed by the angle that it covers; those inside it
 * have a closed form.
 *
 * @param separation - Between the two centres.
 * @param sunRadius - Same unit, > 0.
 * @param moonRadius - Same unit.
 * @param u - Limb darkening, I(ρ) ∝ 1 − u (1 − √(1 − ρ²)).
 */
export function coveredSun(
  separation: number,
  sunRadius: number,
  moonRadius: number,
  u = 0
): number {
  const s = separation / sunRadius
  const m = moonRadius / sunRadius
  if (!(s < 1 + m)) return 0
  const first = Math.min(Math.abs(m - s), 1)
  const last = Math.min(m + s, 1)
  let covered = m > s ? lightWithin(first, u) : 0
  // ρ = middle − half cos πx: the covered angle has square roots at both ends.
  const middle = (first + last) / 2
  const half = (last - first) / 2
  RULE.nodes.forEach((x, i) => {
    const rho = middle - half * Math.cos(Math.PI * x)
    const cosine = (rho * rho + s * s - m * m) / (2 * rho * s || 1)
    const angle = Math.acos(Math.min(Math.max(cosine, -1), 1)) / Math.PI
    const intensity = (1 - u * (1 - Math.sqrt(Math.max(1 - rho * rho, 0)))) / (1 - u / 3)
    const width = Math.PI * half * Math.sin(Math.PI * x) * RULE.weights[i]
    covered += 2 * rho * intensity * angle * width
  })
  return Math.min(covered, 1)
}

/**
 * Part of the sun's light that is left in an eclipse, the corona included; one value per wavelength.
 *
 * @param separation - Between the centres of sun and moon [rad].
 * @param sunRadius - Angular [rad].
 * @param moonRadius - Angular [rad].
 */
export function eclipsedSun(
  separation: number,
  sunRadius: number,
  moonRadius: number,
  limbDarkening: Spectrum
): Spectrum {
  if (separation >= sunRadius + moonRadius) return [1, 1, 1, 1]
  return limbDarkening.map(
    u => CORONA + (1 - CORONA) * (1 - coveredSun(separation, sunRadius, moonRadius, u))
  ) as unknown as Spectrum
}
