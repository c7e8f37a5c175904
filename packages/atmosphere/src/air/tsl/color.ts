import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import type { Vec3, Vec4 } from '../../tsl-types'

function apply(columns: AtmosphereUniforms['linearSRGB'], spectrum: Vec4): Vec3 {
  return columns[0]
    .mul(spectrum.x)
    .add(columns[1].mul(spectrum.y))
    .add(columns[2].mul(spectrum.z))
    .add(columns[3].mul(spectrum.w))
}

/**
 * Radiance per unit of solar irradiance [1/sr] (or irradiance per unit [1]) to linear-sRGB luminance
 * (illuminance), scaled by `luminanceScale`. Colours outside the gamut keep their other components.
 *
 * @param lost - Light that is taken away, as {@link unclampedSRGB} has it.
 */
export function linearSRGB(
  uniforms: AtmosphereUniforms,
  spectrum: Vec4,
  lost: Vec3 | number = 0
): Vec3 {
  return unclampedSRGB(uniforms, spectrum).sub(lost).max(0)
}

/** As {@link linearSRGB}, with components below 0 where colours are outside the gamut, for light that is taken away. */
export function unclampedSRGB(uniforms: AtmosphereUniforms, spectrum: Vec4): Vec3 {
  return apply(uniforms.linearSRGB, spectrum)
}

/** Spectral transmittance to the factors by which the linear-sRGB components of sunlight dim. */
export function transmittanceRGB(uniforms: AtmosphereUniforms, transmittance: Vec4): Vec3 {
  return apply(uniforms.transmittanceRGB, transmittance).clamp(0, 1)
}
