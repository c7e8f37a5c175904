import type { AtmosphereParameters } from '../../parameters/AtmosphereParameters'
import { distanceToAir, distanceToTop } from '../../air/cpu/boundary'
import { densities, extinction } from '../../air/cpu/medium'
import { gaussLegendre } from '../../math/cpu/quadrature'

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
  const columns: [number, number, number] = [0, 0, 0]
  // Pieces lengthen away from the ray's lowest point, where the air is densest.
  const lowest = Math.min(Math.max(-radius * cosView, 0), distance)
  const piece = (from: number, to: number): void => {
    RULE.nodes.forEach((node, i) => {
      const t = from + (to - from) * node
      const altitude = Math.sqrt(radius ** 2 + 2 * radius * cosView * t + t ** 2) - p.bottomRadius
      const weight = RULE.weights[i] * Math.abs(to - from)
      densities(p, Math.max(altitude, 0)).forEach((value, k) => (columns[k] += value * weight))
    })
  }
  for (const end of [0, distance]) {
    for (let i = 0; i < PIECES && end !== lowest; i++) {
      const at = (x: number): number => lowest + (end - lowest) * (x / PIECES) ** 2
      piece(at(i), at(i + 1))
    }
  }
  return extinction(p, columns)
}

/** Part of the sun's disc above the horizon, in [0, 1]; smoothstep stands for the cut disc's area. */
export function visibleDisc(p: AtmosphereParameters, radius: number, cosLight: number): number {
  const sinHorizon = Math.min(p.bottomRadius / radius, 1)
  const cosHorizon = -Math.sqrt(1 - sinHorizon ** 2)
  const margin = sinHorizon * p.sunAngularRadius
  const x = Math.min(Math.max((cosLight - cosHorizon + margin) / (2 * margin), 0), 1)
  return x * x * (3 - 2 * x)
}

/** Optical depth from a point to space; 0 if the ray misses the air. */
function depthToSpace(p: AtmosphereParameters, radius: number, cosView: number): number[] {
  let [r, mu] = [radius, cosView]
  if (r > p.topRadius) {
    const entry = distanceToAir(r, mu, p.topRadius)
    if (entry === null) return [0, 0, 0, 0]
    ;[r, mu] = [p.topRadius, (r * mu + entry) / p.topRadius]
  }
  return opticalDepth(p, r, mu, distanceToTop(r, mu, p.topRadius))
}

/** Sun's radii above the horizon from where on the light of its disc is that of its centre. */
const HIGH_SUN = 36

/**
 * Mean transmittance to the part of the sun's disc that is above the horizon, one value per
 * wavelength: ∫ T(cos θ) sin² θ dθ / ∫ sin² θ dθ with cos θ the height on the disc.
 *
 * From 36 of its radii above the horizon (9.6° for the Earth's sun) that of the centre: they differ by
 * less than 0.02 %.
 *
 * @param radius - Planet's centre to the point [m]; outside the air as well.
 * @param cosLight - μ_s.
 */
export function discTransmittance(
  p: AtmosphereParameters,
  radius: number,
  cosLight: number
): number[] {
  const horizon = Math.PI - Math.asin(Math.min(p.bottomRadius / radius, 1))
  const elevation = (horizon - Math.acos(cosLight)) / p.sunAngularRadius
  const sum = [0, 0, 0, 0]
  let area = 0
  const add = (height: number, weight: number): void => {
    const above = Math.max(elevation + height, 0)
    const depth = depthToSpace(p, radius, Math.cos(horizon - p.sunAngularRadius * above))
    depth.forEach((value, i) => (sum[i] += weight * Math.exp(-value)))
    area += weight
  }
  const last = Math.acos(Math.max(-elevation, -1))
  if (elevation > HIGH_SUN) add(0, 1)
  else {
    RULE.nodes.forEach((node, i) =>
      add(Math.cos(last * node), RULE.weights[i] * Math.sin(last * node) ** 2)
    )
  }
  return sum.map(value => value / area)
}

/**
 * Part of the sun's light that arrives at a point, one value per wavelength, in [0, 1]: mean over the
 * part of the disc above the horizon, times that part.
 *
 * @param radius - Planet's centre to the point [m]; outside the air as well.
 * @param cosLight - μ_s.
 */
export function lightTransmittance(
  p: AtmosphereParameters,
  radius: number,
  cosLight: number
): number[] {
  const visible = visibleDisc(p, radius, cosLight)
  if (visible === 0) return [0, 0, 0, 0]
  return discTransmittance(p, radius, cosLight).map(value => visible * value)
}
