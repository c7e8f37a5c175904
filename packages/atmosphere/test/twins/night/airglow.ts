/** Luminous layer around a planet, a Gaussian in altitude. */
export interface AirglowLayer {
  /** Altitude of the layer's middle [m]. */
  altitude: number
  /** Standard deviation [m]. */
  width: number
}

/**
 * Van Rhijn factor of a layer: the integral of its emission along a ray over that along a vertical, by
 * the trapezoid rule. Twin of night/tsl/airglow.ts, both crossings together.
 *
 * @param radius - Planet's centre to the start of the line [m].
 * @param cosView - μ of the line at its start.
 * @param bottomRadius - Planet's centre to the ground [m].
 * @param distance - Length of the line [m].
 */
export function vanRhijnFactor(
  { altitude, width }: AirglowLayer,
  radius: number,
  cosView: number,
  bottomRadius: number,
  distance: number
): number {
  const steps = 200_000
  let sum = 0
  for (let i = 0; i <= steps; i++) {
    const t = (distance * i) / steps
    const height = Math.sqrt(radius ** 2 + 2 * radius * cosView * t + t ** 2) - bottomRadius
    const weight = i === 0 || i === steps ? 0.5 : 1
    sum += weight * Math.exp(-0.5 * ((height - altitude) / width) ** 2)
  }
  return (sum * distance) / steps / (width * Math.sqrt(2 * Math.PI))
}
