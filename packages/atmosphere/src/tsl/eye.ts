import type { Float } from '../tsl-types'

/**
 * What the sky volume needs to know of the place that it is seen from: scalars of the mapped,
 * spherical space. Values come from cpu/eye.ts.
 */
export interface EyeScalars<T> {
  /** h of the eye, at least 1 m; may be above the air [m]. */
  altitude: T
  /** μ_s, sun against zenith. */
  cosSun: T
  /** Cosine of the zenith angle of the horizon, ≤ 0. */
  cosHorizon: T
  /** Its sine. */
  sinHorizon: T
  /** tan(α/2) of the largest angle α below the horizon, the nadir's. */
  belowSpan: T
  /** The same above the horizon: to the zenith, or from outside the air to its top limb. */
  aboveSpan: T
  /** κ of the distances along rays to the ground: t(x) = t_max (e^{κx} − 1)/(e^κ − 1). */
  groundExponent: T
  /** e^κ − 1 of the same. */
  groundGrowth: T
  /** κ of the distances along rays to the top of the air. */
  skyExponent: T
  /** e^κ − 1 of the same. */
  skyGrowth: T
}

/** {@link EyeScalars} as shader nodes, and the number of its volume in the atlas. */
export interface Eye extends EyeScalars<Float> {
  slot: Float
}
