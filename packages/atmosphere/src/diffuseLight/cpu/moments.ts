import { SH0, SH1, SH20, SH21, SH22 } from '../tsl/moments'

/** Real spherical harmonics of degree ≤ 2 of a unit vector whose y does not matter by symmetry. */
function harmonics(x: number, z: number): [number, number, number, number, number, number] {
  const ySquared = 1 - x * x - z * z
  return [SH0, SH1 * z, SH1 * x, SH20 * (3 * z * z - 1), SH21 * x * z, SH22 * (x * x - ySquared)]
}

/**
 * Σ_l a_l Σ_m M_lm Y_lm(v) for a field that is symmetric about the light's vertical plane.
 *
 * @param moments - M₀₀, M₁₀, M₁₁/sin θ_s, M₂₀, M₂₁/sin θ_s, M₂₂/sin² θ_s.
 * @param weights - a₀, a₁, a₂.
 * @param cosView - v against the zenith.
 * @param cosLight - μ_s, the light against the zenith.
 * @param cosViewLight - ν, v against the light.
 */
export function applyMoments(
  moments: readonly number[],
  weights: readonly [number, number, number],
  cosView: number,
  cosLight: number,
  cosViewLight: number
): number {
  const sinLight = Math.max(Math.sqrt(Math.max(1 - cosLight ** 2, 0)), 1e-9)
  const x = (cosViewLight - cosView * cosLight) / sinLight
  const [y00, y10, y11, y20, y21, y22] = harmonics(x, cosView)
  const [m00, m10, m11, m20, m21, m22] = moments as [number, number, number, number, number, number]
  return (
    weights[0] * m00 * y00 +
    weights[1] * (m10 * y10 + m11 * sinLight * y11) +
    weights[2] * (m20 * y20 + m21 * sinLight * y21 + m22 * sinLight ** 2 * y22)
  )
}
