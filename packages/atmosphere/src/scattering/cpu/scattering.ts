import { spectrumOf, type AtmosphereParameters } from '../../parameters/AtmosphereParameters'
import { distanceToAir, distanceToGround, distanceToTop, hitsGround } from '../../air/cpu/boundary'
import { sampleDiffuseLight, type DiffuseLightData } from '../../diffuseLight/cpu/diffuseLight'
import { densities, extinction } from '../../air/cpu/medium'
import { applyMoments } from '../../diffuseLight/cpu/moments'
import { asymmetryMoments, cornetteShanksPhase, rayleighPhase } from '../../air/cpu/phase'
import { gaussLegendre } from '../../math/cpu/quadrature'
import { opticalDepth, lightTransmittance } from '../../transmittance/cpu/transmittance'

/** Quadrature on each piece of a ray, and the number of pieces. */
const RULE = /*#__PURE__*/ gaussLegendre(6)
const PIECES = 10

/** A ray in the mapped, spherical space. */
export interface RayNumbers {
  /** Planet's centre to the origin [m]. */
  radius: number
  /** μ, ray against zenith. */
  cosView: number
  /** μ_s, light against zenith. */
  cosLight: number
  /** ν, ray against the light. */
  cosViewLight: number
}

/** Ray from where it enters the air; null if it misses. */
export function enterAir(p: AtmosphereParameters, ray: RayNumbers): RayNumbers | null {
  if (ray.radius <= p.topRadius) return ray
  const { radius, cosView, cosLight, cosViewLight } = ray
  const entry = distanceToAir(radius, cosView, p.topRadius)
  if (entry === null) return null
  return {
    radius: p.topRadius,
    cosView: (radius * cosView + entry) / p.topRadius,
    cosLight: (radius * cosLight + entry * cosViewLight) / p.topRadius,
    cosViewLight
  }
}

/**
 * Radiance scattered to a ray's origin along a path in the air, for unit irradiance of the light source.
 *
 * @param data - Diffuse-light table; null for single scattering.
 * @param distance - Length of the path, which does not cross the ground [m].
 * @returns One value per wavelength [1/sr].
 */
export function inScatter(
  p: AtmosphereParameters,
  data: DiffuseLightData | null,
  ray: RayNumbers,
  distance: number
): number[] {
  const { radius, cosView, cosLight, cosViewLight } = ray
  const asymmetries = spectrumOf(p.mieAsymmetry)
  const molecularPhase = rayleighPhase(cosViewLight)
  const aerosolPhases = asymmetries.map(g => cornetteShanksPhase(g, cosViewLight))
  const mie = asymmetries.map(asymmetryMoments)
  const sum = [0, 0, 0, 0]
  const thickness = p.topRadius - p.bottomRadius
  const depthBefore = [0, 0, 0, 0]
  let last = 0
  const visit = (t: number, weight: number): void => {
    const r = Math.sqrt(radius ** 2 + 2 * radius * cosView * t + t ** 2)
    const altitude = Math.max(r - p.bottomRadius, 0)
    const [mu, muLight] = [(radius * cosView + t) / r, (radius * cosLight + t * cosViewLight) / r]
    const middle = (last + t) / 2
    const rMiddle = Math.sqrt(radius ** 2 + 2 * radius * cosView * middle + middle ** 2)
    const rLast = Math.sqrt(radius ** 2 + 2 * radius * cosView * last + last ** 2)
    // Simpson's rule from one node to the next.
    const ends = [rLast, rMiddle, r].map(x =>
      extinction(p, densities(p, Math.max(x - p.bottomRadius, 0)))
    )
    const [molecules, aerosols] = densities(p, altitude)
    const sun = lightTransmittance(p, r, muLight)
    const tiles = data && sampleDiffuseLight(data, altitude / thickness, muLight)
    for (let i = 0; i < 4; i++) {
      depthBefore[i] += ((t - last) / 6) * (ends[0][i] + 4 * ends[1][i] + ends[2][i])
      const byMolecules = p.rayleighScattering[i] * molecules
      const byAerosols = p.mieScattering[i] * aerosols
      let source = (byMolecules * molecularPhase + byAerosols * aerosolPhases[i]) * sun[i]
      if (tiles) {
        const moments = tiles.map(tile => tile[i])
        source += byMolecules * applyMoments(moments, [1, 0, 0.1], mu, muLight, cosViewLight)
        source += byAerosols * applyMoments(moments, mie[i], mu, muLight, cosViewLight)
      }
      sum[i] += weight * source * Math.exp(-depthBefore[i])
    }
    last = t
  }
  const lowest = Math.min(Math.max(-radius * cosView, 0), distance)
  for (const [from, to] of [
    [0, lowest],
    [lowest, distance]
  ] as const) {
    if (to <= from) continue
    // Pieces shorten towards the lowest point, where the air is densest.
    const falls = from < lowest
    const at = (x: number): number =>
      falls ? to - (to - from) * (1 - x) ** 2 : from + (to - from) * x ** 2
    for (let piece = 0; piece < PIECES; piece++) {
      const [a, b] = [at(piece / PIECES), at((piece + 1) / PIECES)]
      RULE.nodes.forEach((node, i) => visit(a + (b - a) * node, (b - a) * RULE.weights[i]))
    }
  }
  return sum
}

/**
 * Radiance of sky or ground in a direction, for unit irradiance of the light source; without the sun's disc.
 *
 * @returns One value per wavelength [1/sr].
 */
export function skyRadiance(
  p: AtmosphereParameters,
  data: DiffuseLightData,
  ray: RayNumbers
): number[] {
  const inside = enterAir(p, ray)
  if (inside === null) return [0, 0, 0, 0]
  const { radius, cosView, cosLight, cosViewLight } = inside
  if (!hitsGround(radius, cosView, p.bottomRadius)) {
    return inScatter(p, data, inside, distanceToTop(radius, cosView, p.topRadius))
  }
  const distance = distanceToGround(radius, cosView, p.bottomRadius)
  const air = inScatter(p, data, inside, distance)
  const depth = opticalDepth(p, radius, cosView, distance)
  const ground = groundRadiance(
    p,
    data,
    (radius * cosLight + distance * cosViewLight) / p.bottomRadius
  )
  return air.map((value, i) => value + ground[i] * Math.exp(-depth[i]))
}

/** Radiance of the Lambertian ground where the sun's zenith cosine is `cosLight` [1/sr]. */
export function groundRadiance(
  p: AtmosphereParameters,
  data: DiffuseLightData,
  cosLight: number
): number[] {
  const direct = lightTransmittance(p, p.bottomRadius, cosLight)
  const diffuse = sampleDiffuseLight(data, 0, cosLight)[6]
  return direct.map(
    (value, i) => (p.groundAlbedo[i] / Math.PI) * (value * Math.max(cosLight, 0) + diffuse[i])
  )
}
