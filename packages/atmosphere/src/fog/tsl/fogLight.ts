import { vec4 } from 'three/tsl'
import { diffuseMoments } from '../../diffuseLight/tsl/diffuseLight'
import { applyMoments, momentBasis, SH0, type Moments } from '../../diffuseLight/tsl/moments'
import type { Air } from '../../scattering/tsl/ray'
import { RADIANCE_SCALE } from '../../tables/tableSizes'
import { lightTransmittance } from '../../transmittance/tsl/transmittance'
import type { Float, Vec4 } from '../../tsl-types'
import { airMass, henyeyGreenstein, multipleScattering, type FogLayerNodes } from './heightFog'

/** Fog as its light knows it, as shader nodes. */
export interface FogMedium extends FogLayerNodes {
  /** Altitude of the base [m]. */
  base: Float
  /** g of the droplets. */
  asymmetry: Float
}

/** Light at an altitude in fog, for unit irradiance of its source; directions of view have no part in it. */
export interface FogLight {
  /** Light that arrives unscattered, forward-scattered light included. */
  direct: Vec4
  /** Light that arrives without any scattering by the fog, for what droplets with a phase function scatter exactly once. */
  sharp?: Vec4
  /** Moments of what droplets make of all other light, times `RADIANCE_SCALE` [1/sr]. */
  diffuse: Moments<Vec4>
}

/**
 * Light of a source at an altitude in fog.
 *
 * @param middle - Altitude above the base, in falloff heights.
 * @param cosLight - μ_s of the source.
 * @param clouds - Their part in the light: see `FogOvercast.light`.
 */
export function fogLight(
  { uniforms, transmittance, diffuse }: Air,
  { density, falloff, base, asymmetry }: FogMedium,
  middle: Float,
  cosLight: Float,
  clouds?: { direct: Float; diffuse: Vec4 }
): FogLight {
  const altitude = middle.mul(falloff).add(base).clamp(0, uniforms.thickness).toConst() as Float
  // Similarity: forward-scattered light counts as not scattered.
  const vertical = density.mul(falloff).mul(asymmetry.oneMinus()).toConst()
  const above = vertical.mul(middle.negate().exp()).toConst() as Float
  const total = above.max(vertical).toConst() as Float
  const radius = uniforms.bottomRadius.add(altitude)
  const slant = airMass(radius.div(falloff), cosLight.max(0))
  const cosSlant = slant.reciprocal().toConst() as Float
  const scaled = above.mul(slant).toConst()
  const light = lightTransmittance(uniforms, transmittance, altitude, cosLight).toConst()
  const unscattered = light.mul(clouds?.direct ?? 1).toConst()
  const moments = diffuseMoments(uniforms, diffuse!, altitude, cosLight)
  const often = light.mul(multipleScattering(above, total, cosSlant)).mul(RADIANCE_SCALE / SH0)
  // Moments of a phase function's products: χ_l = g^l.
  const first = vec4(asymmetry).mul(clouds?.diffuse ?? 1)
  const second = first.mul(asymmetry)
  return {
    direct: unscattered.mul(scaled.negate().exp()),
    sharp: unscattered.mul(scaled.div(asymmetry.oneMinus()).negate().exp()),
    diffuse: {
      m00: moments.m00.add(often).mul(clouds?.diffuse ?? 1),
      m10: moments.m10.mul(first),
      m11: moments.m11.mul(first),
      m20: moments.m20.mul(second),
      m21: moments.m21.mul(second),
      m22: moments.m22.mul(second)
    }
  }
}

/** Directions of a view ray and of the light, as cosines. */
interface FogAngles {
  cosView: Float
  cosLight: Float
  cosViewLight: Float
}

/**
 * Light that fog scatters to the camera, as if all of it were at one point [1/sr]: once, and more often.
 *
 * @param asymmetry - g of the droplets.
 * @param phase - Phase function of the droplets [1/sr]; by default the smooth one of `asymmetry`.
 */
export function scatteredByFog(
  { direct, sharp, diffuse }: FogLight,
  { cosView, cosLight, cosViewLight }: FogAngles,
  asymmetry: Float,
  phase?: Vec4
): { once: Vec4; often: Vec4 } {
  const smooth = henyeyGreenstein(cosViewLight, asymmetry).toConst()
  const once = direct.mul(smooth)
  const sky = applyMoments(diffuse, momentBasis(cosView, cosLight, cosViewLight), 1, 1)
  return {
    // What light scattered exactly once has of fine structure: depths unscaled.
    once: phase === undefined ? once : once.add(sharp!.mul(phase.sub(smooth))),
    often: sky.max(0).div(RADIANCE_SCALE)
  }
}
