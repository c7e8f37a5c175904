import type { Float, Vec3 } from '../../tsl-types'

/**
 * Gain of light in a hollow by interreflection of its sides: greater, and tinted, where the ground is bright.
 *
 * All sides of a bowl see the same. With x the share of the sky, ρ the reflectance and 1 the light of an even sky on open ground, light L =
 * x + (1 − x) ρ L, hence L = x / (1 − ρ (1 − x)). The sun lights the bowl by x of what it does to open ground, too,
 * unevenly; of that, bounces add the same factor less 1, evenly.
 *
 * @param albedo - Reflectance ρ of the ground, in [0, 1).
 * @param skyShare - x, share of the sky that is seen, in (0, 1].
 * @returns Factor on light of the sky that is dimmed by x already, ≥ 1. Twin: ../cpu/bouncedLight.ts
 */
export const bouncedLight = (albedo: Vec3, skyShare: Float): Vec3 =>
  albedo.mul(skyShare.oneMinus()).oneMinus().reciprocal()
