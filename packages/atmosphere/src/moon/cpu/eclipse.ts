import type { Spectrum } from '../../parameters/AtmosphereParameters'
import { gaussLegendre } from '../../math/cpu/quadrature'

const QUADRATURE = /*#__PURE__*/ gaussLegendre(16)

/**
 * Light of the whole corona over that of the sun's disc: the light left in totality.
 *
 * @see Allen 1976, §84: 0.6e-6 to 1.3e-6 with the solar cycle
 */
export const CORONA_LIGHT = 1e-6

/**
 * Encircled light of a limb-darkened disc: the light within a radius, over that of the whole disc.
 *
 * @param rho - Radius over the disc's, in [0, 1].
 */
const encircledLight = (rho: number, u: number): number => {
  const cosine = Math.sqrt(Math.max(1 - rho * rho, 0))
  return ((1 - u) * rho ** 2 + (2 / 3) * u * (1 - cosine ** 3)) / (1 - u / 3)
}

/**
 * Obscuration of the sun: fraction of its light hidden by a round, dark disc, in [0, 1].
 *
 * Rings of the sun inside the dark disc have a closed form. Rings that it covers in part are summed by
 * Gauss–Legendre quadrature over their radius, weighted by the covered angle.
 *
 * @param separation - Distance between the two centres.
 * @param sunRadius - Same unit, > 0.
 * @param moonRadius - Same unit.
 * @param u - Limb darkening, I(ρ) ∝ 1 − u (1 − √(1 − ρ²)).
 */
export function sunObscuration(
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
  let covered = m > s ? encircledLight(first, u) : 0
  // ρ = middle − half cos πx: the covered angle has square roots at both ends.
  const middle = (first + last) / 2
  const half = (last - first) / 2
  QUADRATURE.nodes.forEach((x, i) => {
    const rho = middle - half * Math.cos(Math.PI * x)
    const cosine = (rho * rho + s * s - m * m) / (2 * rho * s || 1)
    const angle = Math.acos(Math.min(Math.max(cosine, -1), 1)) / Math.PI
    const intensity = (1 - u * (1 - Math.sqrt(Math.max(1 - rho * rho, 0)))) / (1 - u / 3)
    const width = Math.PI * half * Math.sin(Math.PI * x) * QUADRATURE.weights[i]
    covered += 2 * rho * intensity * angle * width
  })
  return Math.min(covered, 1)
}

/**
 * Sunlight in an eclipse over full sunlight, the corona included; one value per wavelength.
 *
 * @param separation - Angle between the centres of sun and moon [rad].
 * @param sunRadius - Angular radius [rad].
 * @param moonRadius - Angular radius [rad].
 */
export function eclipsedSunlight(
  separation: number,
  sunRadius: number,
  moonRadius: number,
  limbDarkening: Spectrum
): Spectrum {
  if (separation >= sunRadius + moonRadius) return [1, 1, 1, 1]
  return limbDarkening.map(
    u =>
      CORONA_LIGHT + (1 - CORONA_LIGHT) * (1 - sunObscuration(separation, sunRadius, moonRadius, u))
  ) as unknown as Spectrum
}
