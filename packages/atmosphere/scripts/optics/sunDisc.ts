/** Angular radius of the sun's disc [°]. */
export const SUN_RADIUS = 0.2665

const RINGS = 6
const SPOKES = 24

/**
 * Mean over the sun's disc of a function of the angle from the sun or from the point opposite.
 *
 * @param at - The function; angles are positive [°].
 * @param angle - Angle from the middle of the disc [°].
 */
export function overSunDisc(at: (angle: number) => number, angle: number): number {
  let sum = 0
  for (let i = 0; i < RINGS; i++) {
    const radius = SUN_RADIUS * Math.sqrt((i + 0.5) / RINGS)
    for (let k = 0; k < SPOKES; k++) {
      const spoke = ((k + 0.5) / SPOKES) * Math.PI
      sum += at(Math.hypot(angle + radius * Math.cos(spoke), radius * Math.sin(spoke)))
    }
  }
  return sum / (RINGS * SPOKES)
}
