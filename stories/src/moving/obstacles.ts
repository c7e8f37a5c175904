import type { Vector3 } from 'three'

/** Upright box that stands in the way: its place and size on the map, turn about the vertical [rad], and top above the datum [m]. */
export interface Obstacle {
  readonly x: number
  readonly z: number
  readonly width: number
  readonly depth: number
  readonly turn?: number
  readonly top: number
}

/** Half width of a body: nearer to a wall, a camera would see through it [m]. */
const BODY = 0.8

/**
 * Height of the top of what stands at a place [m]: a function for walks; −∞ where nothing does.
 *
 * @param margin - Distance from boxes that one keeps, default for a camera whose near plane is half a metre away [m].
 */
export function topOf(
  obstacles: readonly Obstacle[],
  margin = BODY
): (position: Pick<Vector3, 'x' | 'z'>) => number {
  return ({ x, z }) => {
    let highest = -Infinity
    for (const { x: middleX, z: middleZ, width, depth, turn = 0, top } of obstacles) {
      const [dx, dz] = [x - middleX, z - middleZ]
      const [cos, sin] = [Math.cos(turn), Math.sin(turn)]
      const isInside =
        Math.abs(dx * cos - dz * sin) < width / 2 + margin &&
        Math.abs(dx * sin + dz * cos) < depth / 2 + margin
      if (isInside) highest = Math.max(highest, top)
    }
    return highest
  }
}
