import type { PNG } from 'pngjs'

/** A camera that looks away from the sun [°]. */
export interface BowView {
  /** Vertical field of view, and pitch. */
  readonly fieldOfView: number
  readonly pitch: number
  /** Elevation of the sun, and its azimuth less that of the view, clockwise. */
  readonly sun: number
  readonly aside: number
}

/** Bows as rings about the point opposite the sun: bands of their blue and red sides, and of the air beyond the red one [°]. */
const rings = {
  /** Violet to green at 40.6 to 41.6°, red up to 42.4°; the dark band beyond. */
  primary: [
    [40, 41.2],
    [41.9, 42.9],
    [44, 46]
  ],
  /** The other way round. */
  secondary: [
    [52.2, 53.8],
    [50, 51.3],
    [46, 48]
  ]
} as const

/** Length of arcs that are looked at one by one, and pixels that each must have in either band. */
const ARC = 6
const LEAST = 8

/** Excess of red over blue of a ring's red side over those beside it from which on an arc counts [1/255]. */
const SEEN = 1.5

const radians = (degrees: number): number => (degrees * Math.PI) / 180

/** Angle from the point opposite the sun, and around it from above [°], of a pixel. */
function aroundOpposite(
  { fieldOfView, pitch, sun, aside }: BowView,
  { width, height }: Pick<PNG, 'width' | 'height'>,
  x: number,
  y: number
): [away: number, around: number] {
  const scale = Math.tan(radians(fieldOfView) / 2) / (height / 2)
  const [right, up] = [(x + 0.5 - width / 2) * scale, (height / 2 - y - 0.5) * scale]
  const length = Math.hypot(right, up, 1)
  const [sine, cosine] = [Math.sin(radians(pitch)), Math.cos(radians(pitch))]
  // East of the view, up, ahead.
  const ray = [right, up * cosine + sine, cosine - up * sine].map(value => value / length)
  const [height0, turn] = [radians(sun), radians(aside)]
  const opposite = [
    -Math.cos(height0) * Math.sin(turn),
    -Math.sin(height0),
    -Math.cos(height0) * Math.cos(turn)
  ]
  const dot = ray.reduce((sum, value, i) => sum + value * opposite[i], 0)
  const across = ray[0] * Math.cos(turn) - ray[2] * Math.sin(turn)
  const above = (ray[1] - dot * opposite[1]) / Math.cos(height0)
  return [Math.acos(dot) / radians(1), Math.atan2(-across, above) / radians(1)]
}

/** Degrees of a ring on which its colours are seen in their order; arcs hidden by the ground or outside of the picture do not count. */
export interface Bows {
  readonly primary: number
  readonly secondary: number
}

/**
 * Bows in a picture: arcs of each ring on which its red side is redder than the bands to either side of it. Arcs on which it is bluer
 * than both are taken off: where there is no bow, there are as many of these.
 */
export function bowsIn(picture: PNG, view: BowView): Bows {
  const found = { primary: 0, secondary: 0 }
  for (const name of ['primary', 'secondary'] as const) {
    /** Sums of red less blue, and counts, of the bands by arcs. */
    const arcs = Array.from({ length: 360 / ARC }, () => rings[name].map(() => [0, 0]))
    for (let y = 0; y < picture.height; y++)
      for (let x = 0; x < picture.width; x++) {
        const [away, around] = aroundOpposite(view, picture, x, y)
        const band = rings[name].findIndex(([from, to]) => away >= from && away < to)
        if (band < 0) continue
        const sums = arcs[Math.floor((around + 180) / ARC) % arcs.length][band]
        const pixel = 4 * (y * picture.width + x)
        sums[0] += picture.data[pixel] - picture.data[pixel + 2]
        sums[1]++
      }
    for (const bands of arcs) {
      if (bands.some(([, count]) => count < LEAST)) continue
      const [blue, red, beyond] = bands.map(([sum, count]) => sum / count)
      if (red - Math.max(blue, beyond) > SEEN) found[name] += ARC
      if (Math.min(blue, beyond) - red > SEEN) found[name] -= ARC
    }
  }
  return { primary: Math.max(found.primary, 0), secondary: Math.max(found.secondary, 0) }
}
