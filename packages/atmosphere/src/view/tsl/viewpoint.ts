import type { Float, Vec2 } from '../../tsl-types'

/**
 * Viewpoint of a sky volume: scalars of the mapped, spherical space. Values come from cpu/viewpoint.ts.
 */
export interface ViewpointScalars<T> {
  /** h of the viewpoint, at least 1 m; may be above the air [m]. */
  altitude: T
  /** Distance from the planet's centre [m]. */
  radius: T
  /** Square of the distance to the horizon, h (2 r_ground + h) [m²]. */
  toHorizon: T
  /** Square of that to the top of the air along the level; negative above the air [m²]. */
  toTop: T
  /** μ_s, light against zenith. */
  cosLight: T
  /** √(1 − μ_s²). */
  sinLight: T
  /** Cosine of the zenith angle of the horizon, ≤ 0. */
  cosHorizon: T
  /** Its sine. */
  sinHorizon: T
  /** 1/tan(α/2) of the largest angle α below the horizon, the nadir's. */
  belowScale: T
  /** Scale above the horizon: to the zenith, or from outside the air to its top limb. */
  aboveScale: T
  /** 1/κ of the distances along rays to the ground: t(x) = t_max (e^{κx} − 1)/(e^κ − 1). */
  groundStretch: T
  /** e^κ − 1 of the same. */
  groundGrowth: T
  /** 1/κ of the distances along rays to the top of the air. */
  skyStretch: T
  /** e^κ − 1 of the same. */
  skyGrowth: T
}

/** {@link ViewpointScalars} as shader nodes, and where its sky volume is in the atlas. */
export interface Viewpoint extends ViewpointScalars<Float> {
  /** First texel of the volume's light. */
  lightOrigin: Vec2
  /** First texel of its table of mean extinction. */
  depthOrigin: Vec2
}
