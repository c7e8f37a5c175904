/**
 * Float64 twin of the interreflection in a hollow, summed bounce by bounce.
 *
 * @param albedo - Reflectance of the ground, in [0, 1).
 * @param skyShare - Share of the sky that is seen, in (0, 1].
 * @returns Factor on light of the sky that is dimmed by the share already, ≥ 1.
 */
export function bouncedLight(albedo: number, skyShare: number): number {
  let sum = 0
  for (let light = 1; light > 1e-12; light *= albedo * (1 - skyShare)) sum += light
  return sum
}
