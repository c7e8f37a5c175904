import type { Vector3 } from 'three'
import type { FlashKind } from './flashCurve'

/** Options of {@link lightning}. */
export interface LightningOptions {
  /** See `Lightning.rate`; by default 0: only on call. */
  rate?: number
  /** See `Lightning.groundShare`; by default 0.3. */
  groundShare?: number
  /** See `Lightning.enabled`; by default true. */
  enabled?: boolean
  /** See `Lightning.limit`; by default 0.3. */
  limit?: number | null
  /** See `Lightning.exposure`; by default null. */
  exposure?: number | null
  /** See `Lightning.time`; by default null. */
  time?: number | null
  /** Flashes are the same for the same seed, a whole number; by default 1. */
  seed?: number
}

/** Kind and place of a flash. */
export interface StrikeOptions {
  /** To the ground or in the cloud; left out, by `groundShare`. */
  kind?: FlashKind
  /** Place, in world space: its column is struck, whatever is there. Left out, a strong column around the camera. */
  at?: Vector3
}

/** A flash that begins, or its thunder that arrives. */
export interface LightningEvent {
  /** To the ground or in the cloud. */
  kind: FlashKind
  /** Distance of its nearest part from the camera [m]. */
  distance: number
  /** Time from the flash to its thunder [s]. */
  delay: number
  /** Time over which its thunder arrives: from the nearest part to the farthest [s]. */
  duration: number
}

/** Events of `Lightning`. */
export interface LightningEventMap {
  /** A flash begins. */
  strike: LightningEvent
  /** Its thunder arrives at the camera. */
  thunder: LightningEvent
}
