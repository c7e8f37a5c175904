import type { Float } from '../../tsl-types'

/** Cosines between the ground's normal, the sun and the camera. */
export interface GroundAngles {
  /** Sun and normal. */
  cosLight: Float
  /** Camera and normal, in (0, 1]. */
  cosViewer: Float
  /** Sun and camera. */
  cosLightViewer: Float
}

/**
 * Oren–Nayar reflectance of rough ground, over that of Lambertian ground.
 *
 * @param roughness - σ, standard deviation of the facets' slope angles [rad].
 * @see Oren & Nayar 1994, "Generalization of Lambert's reflectance model", "Qualitative model"; in the form of
 *   Fujii, "A tiny improvement of Oren–Nayar reflectance model", "Proposed formula", which keeps it free of
 *   tangents.
 */
export function orenNayar(angles: GroundAngles, roughness: Float): Float {
  const variance = roughness.mul(roughness).toConst()
  const even = variance.mul(0.5).div(variance.add(0.33)).oneMinus()
  const uneven = variance.mul(0.45).div(variance.add(0.09))
  const cosLight = angles.cosLight.max(0).toConst()
  const along = angles.cosLightViewer.sub(cosLight.mul(angles.cosViewer)).toConst()
  const longest = along.greaterThan(0).select(cosLight.max(angles.cosViewer), 1).max(1e-3)
  return along.div(longest).mul(uneven).add(even).max(0)
}

/** Reflectance of water at normal incidence, refractive index 1.34. */
const WATER_FRESNEL = ((1.34 - 1) / (1.34 + 1)) ** 2

/**
 * Fresnel reflectance of water.
 *
 * @see Akenine-Möller et al. 2018, Real-Time Rendering, 4th ed., §9.5, after Schlick 1994, "An inexpensive BRDF
 *   model for physically-based rendering"
 */
export function waterFresnel(cosine: Float): Float {
  const rest = cosine.oneMinus().clamp().toConst()
  const square = rest.mul(rest)
  return square
    .mul(square)
    .mul(rest)
    .mul(1 - WATER_FRESNEL)
    .add(WATER_FRESNEL)
}

/**
 * Λ of Smith's shadowing for Gaussian slopes.
 *
 * @see Walter et al. 2007, "Microfacet models for refraction through rough surfaces", §5.2 (Beckmann
 *   distribution): G₁ = 1/(1 + Λ)
 */
function smithLambda(cosine: Float, slope: Float): Float {
  const sine = cosine.mul(cosine).oneMinus().max(1e-6).sqrt()
  const a = cosine.max(0).div(sine.mul(slope)).min(1.6).toConst()
  const square = a.mul(a)
  return square
    .mul(0.396)
    .sub(a.mul(1.259))
    .add(1)
    .div(a.mul(3.535).add(square.mul(2.181)).max(1e-5))
}

/**
 * Mean square slope of the sea's surface in a wind.
 *
 * @param windSpeed - 12.5 m above the water [m/s].
 * @see Mobley 2021, "Ocean Optics Web Book", "Cox-Munk sea surface slope statistics", after Cox & Munk 1954,
 * "Measurement of the roughness of the sea surface from photographs of the sun's glitter"
 */
export const seaSlopeVariance = (windSpeed: number): number => 0.003 + 5.12e-3 * windSpeed

/**
 * Radiance of the sun's glint on the sea, for unit irradiance of the sun at the water [1/sr]:
 * F P(slope)/(4 cos θ_eye cos⁴β), with P Gaussian, and slopes in each other's shadow left out.
 *
 * @param variance - {@link seaSlopeVariance}.
 * @see Mobley 2021, "Ocean Optics Web Book", "Cox-Munk sea surface slope statistics"; shadowing as for `smithLambda`
 */
export function sunGlint(angles: GroundAngles, variance: Float): Float {
  const { cosLight, cosViewer, cosLightViewer } = angles
  // Half vector h of unit length: |l + v|² = 2 (1 + l·v).
  const length = cosLightViewer.add(1).mul(2).max(1e-6).sqrt().toConst()
  const cosTilt = cosLight.add(cosViewer).div(length).clamp(1e-3, 1).toConst()
  const square = cosTilt.mul(cosTilt).toConst()
  const slopes = square.reciprocal().sub(1).div(variance).negate().exp()
  const distribution = slopes.div(variance.mul(Math.PI).mul(square).mul(square))
  const slope = variance.sqrt().toConst()
  // Shadowing keeps this positive where the camera's cosine is 0.
  const visible = smithLambda(cosLight, slope)
    .add(smithLambda(cosViewer, slope))
    .add(1)
    .mul(cosViewer)
  const glint = waterFresnel(length.mul(0.5)).mul(distribution).div(visible.mul(4))
  return cosLight.greaterThan(0).select(glint, 0)
}

/**
 * Reflectance of the sea for diffuse skylight: Fresnel's at a mean slope.
 *
 * @param variance - {@link seaSlopeVariance}.
 */
export function skyReflectance(cosViewer: Float, variance: Float): Float {
  return waterFresnel(cosViewer.mul(cosViewer).add(variance).sqrt().min(1))
}
