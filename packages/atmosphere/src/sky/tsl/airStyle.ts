import { mix, step, vec4 } from 'three/tsl'
import type { Float, Vec4 } from '../../tsl-types'
import type { MediumSegment } from '../../skyVolume/tsl/skyVolume'

/** Optical depth below which 1 − e^{−τ} is a series: it loses three digits there in float32. */
const THIN = 0.03

/** 1 − e^{−τ}; the series is within 1e-8 of it. */
function opacity(depth: Vec4): Vec4 {
  const next = (sum: Vec4, n: number): Vec4 => depth.mul(sum).div(-n).add(1)
  const series = depth.mul([4, 3, 2].reduce<Vec4>((sum, n) => next(sum, n), vec4(1)))
  return mix(series, depth.negate().exp().oneMinus(), step(THIN, depth))
}

/**
 * Air as if it were denser by a factor: τ → kτ, and light L → L (1 − e^{−kτ})/(1 − e^{−τ}), which is that of air
 * whose source function is the same all along the ray.
 *
 * @param strength - k ≥ 0.
 */
export function denserAir({ depth, radiance }: MediumSegment, strength: Float): MediumSegment {
  const thin = depth.max(1e-20).toConst() as Vec4
  const denser = thin.mul(strength).toConst() as Vec4
  return {
    depth: depth.mul(strength),
    radiance: radiance.mul(opacity(denser)).div(opacity(thin))
  }
}

/**
 * Light of the same luminance, with its distance from grey multiplied.
 *
 * @param radiance - Over `solarIrradiance`: grey is the same at all four wavelengths.
 * @param luminous - Share of each wavelength in the luminance of grey light; their sum is 1.
 * @param saturation - 0 is grey, 1 leaves light as it is.
 */
export function saturated(radiance: Vec4, luminous: Vec4, saturation: Float): Vec4 {
  const grey = vec4(radiance.dot(luminous)).toConst()
  return radiance.sub(grey).mul(saturation).add(grey).max(0)
}
