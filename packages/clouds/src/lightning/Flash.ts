import { Vector3 } from 'three'
import { fromCamera, type PlacedChannel } from './channel'
import type { FlashCurve, FlashKind } from './flashCurve'
import type { LightningEvent } from './LightningOptions'

/** Speed of sound at 15 °C [m/s]. */
const SPEED_OF_SOUND = 340

const _point = new Vector3()

/** A flash under way. */
export interface Flash extends PlacedChannel {
  readonly kind: FlashKind
  readonly curve: FlashCurve
  /** Time when it began [s]. */
  readonly start: number
}

/** Thunder of a flash. */
export function eventOf(flash: Flash, viewpoint: Vector3): LightningEvent {
  let [nearest, farthest] = [Infinity, 0]
  for (const { from } of flash.pieces) {
    const distance = fromCamera(flash, viewpoint, from, _point).length()
    nearest = Math.min(nearest, distance)
    farthest = Math.max(farthest, distance)
  }
  return {
    kind: flash.kind,
    distance: nearest,
    delay: nearest / SPEED_OF_SOUND,
    duration: (farthest - nearest) / SPEED_OF_SOUND
  }
}
