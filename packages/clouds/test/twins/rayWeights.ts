/** Float64 twin of `rayWeights` where pixels share rays: means of pairs of rays, and what lies between two of them. */
export function sharedWeights(place: number): Map<number, number> {
  const pair = Math.floor(place - 0.5)
  const part = place - 0.5 - pair
  const weights = new Map<number, number>()
  for (const [ray, weight] of [
    [pair, 1 - part],
    [pair + 1, 1 - part],
    [pair + 1, part],
    [pair + 2, part]
  ]) {
    weights.set(ray, (weights.get(ray) ?? 0) + weight / 2)
  }
  return weights
}
