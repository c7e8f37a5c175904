import { If, vec2, vec3 } from 'three/tsl'
import { loop, type Float, type Vec3 } from '../../tsl-types'

/** Foreground of a pixel. */
export interface SeenForeground {
  /** Its distance [m]. */
  readonly distance: Float
  /** Parts of the picture that are light up to it, and light up to what is behind it, in [0, 1]. */
  readonly before: Float
  readonly behind: Float
}

/**
 * Light of a ray's air, as much as is seen through a foreground, and all of it up to what is behind.
 *
 * @param distance - Distance to what is behind [m].
 * @param lightTo - Light of the air up to a distance.
 * @param least - Part of the picture that is not left out; 0 where all of the light is asked for.
 */
export function seenLight(
  distance: Float,
  front: SeenForeground | undefined,
  lightTo: (distance: Float) => Vec3,
  least = 0
): { seen: Vec3; all: Vec3 } {
  if (front === undefined) {
    const all = lightTo(distance)
    return { seen: all, all }
  }
  const parts = vec2(front.before, front.behind).toConst()
  const seen = vec3(0).toVar() as Vec3
  const all = vec3(0).toVar() as Vec3
  loop('seen', 2, index => {
    const isFront = index.equal(0)
    const part = isFront.select(parts.x, parts.y).toConst()
    If(part.greaterThanEqual(least), () => {
      all.assign(lightTo(isFront.select(front.distance, distance).toConst()))
      seen.addAssign(all.mul(part))
    })
  })
  return { seen, all }
}
