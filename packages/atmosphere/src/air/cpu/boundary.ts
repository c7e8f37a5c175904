/** Float64 twin of the shader function, in the expanded form that it avoids. Lengths [m]. */
export function distanceToTop(radius: number, cosView: number, topRadius: number): number {
  const discriminant = radius ** 2 * (cosView ** 2 - 1) + topRadius ** 2
  return Math.max(-radius * cosView + Math.sqrt(Math.max(discriminant, 0)), 0)
}

/** True if a ray from outside the planet meets the ground: it looks down and passes within it. */
export function hitsGround(radius: number, cosView: number, bottomRadius: number): boolean {
  return cosView < 0 && radius * Math.sqrt(1 - cosView ** 2) <= bottomRadius
}

/** Distance to the near point where a ray's line meets the ground. Lengths [m]. */
export function distanceToGround(radius: number, cosView: number, bottomRadius: number): number {
  const discriminant = radius ** 2 * (cosView ** 2 - 1) + bottomRadius ** 2
  return Math.max(-radius * cosView - Math.sqrt(Math.max(discriminant, 0)), 0)
}

/**
 * Distance from a point above the air to where a ray enters it. Lengths [m].
 *
 * @returns Null if the ray misses the air.
 */
export function distanceToAir(radius: number, cosView: number, topRadius: number): number | null {
  const discriminant = topRadius ** 2 - radius ** 2 * (1 - cosView ** 2)
  if (cosView >= 0 || discriminant <= 0) return null
  return -radius * cosView - Math.sqrt(discriminant)
}
