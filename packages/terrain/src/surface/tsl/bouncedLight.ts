import type { Float, Vec3 } from '../../tsl-types'

/**
 * Light in a hollow with what its sides throw at each other, over that without: more, and tinted, where the ground is bright.
 *
 * Sides of a bowl see all of it alike. With x the share of the sky and ρ the reflectance, light is x + (1 − x) ρ · light of
 * that of a sky that is even on open ground, hence x / (1 − ρ (1 − x)). The sun lights the bowl by x of what it does to open ground, too,
 * unevenly; of that, bounces add the same factor less 1, evenly.
 *
 * @param albedo - Reflectance ρ of the ground, in [0, 1).
 * @param skyShare - x, share of the sky that is seen, in (0, 1].
 * @returns Factor on light of the sky that is dimmed by x already, ≥ 1. Twin: ../cpu/bouncedLight.ts
 */
export const bouncedLight = (albedo: Vec3, skyShare: Float): Vec3 =>
  albedo.mul(skyShare.oneMinus()).oneMinus().reciprocal()
