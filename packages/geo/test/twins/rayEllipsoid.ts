/**
 * Float64 twin of `tsl/rayEllipsoid`'s `raySphere`, from the triangle of centre, chord and origin:
 * r cos = the foot of the perpendicular from the centre, r sin = its length. Lengths [m].
 *
 * @returns Distance [m], or −1 if the ray misses.
 */
export function raySphere(height: number, radius: number, cosView: number): number {
  const eyeRadius = radius + height
  const foot = -eyeRadius * cosView
  const miss = eyeRadius * Math.sqrt((1 - cosView) * (1 + cosView))
  if (miss > radius || (height > 0 && foot < 0)) return -1
  const halfChord = Math.sqrt((radius - miss) * (radius + miss))
  return height > 0 ? foot - halfChord : foot + halfChord
}
