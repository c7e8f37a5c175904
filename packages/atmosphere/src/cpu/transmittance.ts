import type { AtmosphereParameters } from '../AtmosphereParameters'
import { distanceToTop } from './boundary'
import { extinctionAt } from './medium'
import { gaussLegendre } from './quadrature'

const RULE = /*#__PURE__*/ gaussLegendre(8)

/** Pieces that a ray is cut into, where profiles have kinks or are steep. */
const PIECES = 12

/**
 * Optical depth along a ray by composite Gauss–Legendre quadrature, with no table.
 *
 * @param radius - Planet's centre to ray origin [m].
 * @param cosView - μ.
 * @param distance - Length of the ray [m].
 * @returns One value per wavelength.
 */
export function opticalDepth(
  p: AtmosphereParameters,
  radius: number,
  cosView: number,
  distance: number
): number[] {
  const sum = [0, 0, 0, 0]
  // Pieces lengthen away from the ray's lowest point, where the air is densest.
  const lowest = Math.min(Math.max(-radius * cosView, 0), distance)
  const piece = (from: number, to: number): void => {
    RULE.nodes.forEach((node, i) => {
      const t = from + (to - from) * node
      const altitude = Math.sqrt(radius ** 2 + 2 * radius * cosView * t + t ** 2) - p.bottomRadius
      const weight = RULE.weights[i] * Math.abs(to - from)
      extinctionAt(p, Math.max(altitude, 0)).forEach((value, k) => (sum[k] += value * weight))
    })
  }
  for (const end of [0, distance]) {
    for (let i = 0; i < PIECES && end !== lowest; i++) {
      const at = (x: number): number => lowest + (end - lowest) * (x / PIECES) ** 2
      piece(at(i), at(i + 1))
    }
  }
  return sum
}

/** Part of the sun's disc above the horizon, in [0, 1]; smoothstep stands for the cut disc's area. */
export function visibleSun(p: AtmosphereParameters, radius: number, cosSun: number): number {
  const sinHorizon = Math.min(p.bottomRadius / radius, 1)
  const cosHorizon = -Math.sqrt(1 - sinHorizon ** 2)
  const margin = sinHorizon * p.sunAngularRadius
  const x = Math.min(Math.max((cosSun - cosHorizon + margin) / (2 * margin), 0), 1)
  return x * x * (3 - 2 * x)
}

/**
 * Part of the sun's light that arrives at a point, one value per wavelength, in [0, 1].
 *
 * @param radius - Planet's centre to the point [m]; outside the air there is only the planet's shadow.
 * @param cosSun - μ_s.
 */
export function sunTransmittance(
  p: AtmosphereParameters,
  radius: number,
  cosSun: number
): number[] {
  const visible = visibleSun(p, radius, cosSun)
  if (visible === 0) return [0, 0, 0, 0]
  const cosHorizon = -Math.sqrt(Math.max(1 - (p.bottomRadius / radius) ** 2, 0))
  let [r, mu] = [radius, Math.max(cosSun, cosHorizon)]
  if (r > p.topRadius) {
    const discriminant = p.topRadius ** 2 - r ** 2 * (1 - mu ** 2)
    if (mu >= 0 || discriminant <= 0) return [visible, visible, visible, visible]
    const entry = -r * mu - Math.sqrt(discriminant)
    ;[r, mu] = [p.topRadius, (r * mu + entry) / p.topRadius]
  }
  const depth = opticalDepth(p, r, mu, distanceToTop(r, mu, p.topRadius))
  return depth.map(value => visible * Math.exp(-value))
}
