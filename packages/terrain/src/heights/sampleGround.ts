import type { Vector3 } from 'three'
import type { GroundBounds, HeightSample } from './HeightSource'

/**
 * Height and gradient of a source; where one is no number there is a hole: level ground at 0 m, or as near to that as the source's ground comes.
 *
 * @param place - On the figure, ground's own axes [m].
 */
export function sampleGround(
  source: GroundBounds,
  place: Vector3,
  target: HeightSample
): HeightSample {
  const found = source.sampleAt(place, target)
  const { height, gradient } = found
  if (!Number.isFinite(height + gradient.x + gradient.y + gradient.z)) {
    found.height = Math.min(Math.max(0, source.lowest), source.highest)
    gradient.setScalar(0)
  }
  return found
}
