import type { Vector3 } from 'three'
import type { FlareOptions } from '../halo/Flare'

/** Options of `Moon`. */
export interface MoonOptions {
  /** Direction to the moon in world space, any length; null, the default, follows the date. */
  direction?: Vector3 | null
  /** Phase: 0 new, 0.25 first quarter, 0.5 full, 0.75 last quarter, 1 new; null, the default, follows the geometry. */
  phase?: number | null
  /** Distance from the observer [m]; null, the default, follows the date, or is the mean distance without one. */
  distance?: number | null
  /** Radius of the moon, default 1,737,400 [m]. Its light grows with its area. */
  radius?: number
  /** Factor on the brightness of the disc and on moonlight, ≥ 0, default 1. At 0 it still eclipses the sun. */
  strength?: number
  /** Artistic factor on earthshine, the glow of its dark side, ≥ 0, default 1. */
  earthshine?: number
  /** Lights the air: glow of the sky, and haze. Default true. */
  lightsAir?: boolean
  /** Halo around the disc; it waxes and wanes with the moon's light. Defaults: see {@link FlareOptions}. */
  flare?: FlareOptions
  /** Width of the map of the moon's ground, a power of two in [16, 8192], default 1024 [texels]. */
  mapSize?: number
}

/** Appearance of the moon for an observer. */
export interface MoonAppearance {
  /** Observer to moon, world, unit length. */
  direction: Vector3
  /** Observer to the moon's centre [m]. */
  distance: number
  /** Angular radius of the disc [rad]. */
  angularRadius: number
  /** Angle between sun and observer as seen from the moon: 0 full, π new [rad]. */
  phaseAngle: number
  /** Sunlit fraction of the disc, in [0, 1]. */
  litFraction: number
}
