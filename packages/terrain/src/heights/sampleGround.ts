import type { Vector3 } from 'three'
import type { GroundBounds, HeightSample } from './HeightSource'

/** Height of level ground where there is no other: 0 m, or as near to that as the source's ground comes. */
export const levelOf = ({ lowest, highest }: Pick<GroundBounds, 'lowest' | 'highest'>): number =>
  Math.min(Math.max(0, lowest), highest)

/**
 * Height and gradient of a source; where one is no number there is a hole: level ground.
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
    found.height = levelOf(source)
    gradient.setScalar(0)
  }
  return found
}
