/**
 * Float64 twin of `warpedSteps`: the distance is found by bisection of q, whose inverse the shader has.
 *
 * @param radius - Planet's centre to the start of the ray [m].
 * @param cosView - μ at the start.
 * @param homogeneousHeight - Height of the atmosphere, were it as dense all the way as at the ground [m].
 * @param length - Length of the ray [m].
 * @param part - Part of all samples, in [0, 1].
 * @returns [m].
 */
export function warpedDistance(
  radius: number,
  cosView: number,
  homogeneousHeight: number,
  length: number,
  part: number
): number {
  const densest = Math.min(Math.max(-radius * cosView, 0), length)
  const steepness = Math.abs(radius * cosView + densest) / radius
  const scale = homogeneousHeight / (0.133 + 1.33 * steepness)
  const q = (t: number): number => (t - densest) / (scale + Math.abs(t - densest))
  const wanted = q(0) + part * (q(length) - q(0))
  let [low, high] = [0, length]
  for (let i = 0; i < 100; i++) {
    const middle = (low + high) / 2
    if (q(middle) < wanted) low = middle
    else high = middle
  }
  return (low + high) / 2
}
