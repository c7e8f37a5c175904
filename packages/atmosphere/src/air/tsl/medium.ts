import { vec3 } from 'three/tsl'
import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import type { Float, Vec3, Vec4 } from '../../tsl-types'

/**
 * Densities of molecules, aerosols and absorber at an altitude, relative to where their coefficients
 * are given.
 *
 * @param altitude - h ≥ 0 [m].
 * @returns (molecules, aerosols, absorber), each in [0, 1].
 * @see cpu/medium.ts, its twin
 */
export function densities(uniforms: AtmosphereUniforms, altitude: Float): Vec3 {
  const { rayleighScaleHeight, rayleighLayerBases, rayleighLayerSlopes } = uniforms
  const { mieScaleHeight, absorptionAltitude, absorptionHalfWidth } = uniforms
  // −ln of the density is a broken line: its slope changes at the base of every layer.
  const bends = vec3(altitude).sub(rayleighLayerBases).max(0).dot(rayleighLayerSlopes)
  return vec3(
    altitude.div(rayleighScaleHeight).add(bends).negate().exp(),
    altitude.div(mieScaleHeight).negate().exp(),
    altitude.sub(absorptionAltitude).abs().div(absorptionHalfWidth).oneMinus().max(0)
  )
}

/** Extinction coefficient of air with given {@link densities} [1/m]. */
export function extinction(uniforms: AtmosphereUniforms, density: Vec3): Vec4 {
  return uniforms.rayleighScattering
    .mul(density.x)
    .add(uniforms.mieExtinction.mul(density.y))
    .add(uniforms.absorptionExtinction.mul(density.z))
}
