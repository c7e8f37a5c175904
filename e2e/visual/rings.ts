import type { PNG } from 'pngjs'

/** A camera among bows or halos [°]. */
export interface RingView {
  /** Vertical field of view, and pitch. */
  readonly fieldOfView: number
  readonly pitch: number
  /** Elevation of the sun, and its azimuth less that of the view, clockwise. */
  readonly sun: number
  readonly aside: number
}

/** Length of arcs that are looked at one by one [°]. */
const ARC = 6

type Band = readonly [from: number, to: number]

/** A ring about the sun, or about the point opposite it: a band of it, and those to either side of it [°]. */
export interface Ring {
  readonly about: 'sun' | 'opposite'
  readonly band: Band
  readonly sides: readonly [Band, Band]
  /** Quantity of which the band has more than its sides: red less blue, or light. */
  readonly has: 'red' | 'light'
}

/** Rings by their angles. */
export const RINGS = {
  /** Violet to green at 40.6 to 41.6°, red up to 42.4°; the dark band beyond. */
  primary: {
    about: 'opposite',
    band: [41.9, 42.9],
    sides: [
      [40, 41.2],
      [44, 46]
    ],
    has: 'red'
  },
  /** The other way round. */
  secondary: {
    about: 'opposite',
    band: [50, 51.3],
    sides: [
      [46, 48],
      [52.2, 53.8]
    ],
    has: 'red'
  },
  /** White and broad: droplets of 9 µm. */
  fogbow: {
    about: 'opposite',
    band: [36, 40],
    sides: [
      [28, 32],
      [44, 48]
    ],
    has: 'light'
  },
  /** Red at its inner edge; dark inside. */
  halo: {
    about: 'sun',
    band: [21.6, 22.4],
    sides: [
      [19, 20.5],
      [23.2, 24.7]
    ],
    has: 'red'
  }
} as const satisfies Record<string, Ring>

/** Least pixels of an arc in each band. */
const LEAST = 8

/** Excess of a band over its sides from which on an arc counts [1/255]. */
const SEEN = 1.5

const radians = (degrees: number): number => (degrees * Math.PI) / 180

/** Angle from the middle of a ring, and around it [°], of a pixel. */
function aroundMiddle(
  { about }: Ring,
  { fieldOfView, pitch, sun, aside }: RingView,
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
  const middle = [
    Math.cos(height0) * Math.sin(turn),
    Math.sin(height0),
    Math.cos(height0) * Math.cos(turn)
  ].map(value => (about === 'sun' ? value : -value))
  const dot = ray.reduce((sum, value, i) => sum + value * middle[i], 0)
  const across = ray[0] * Math.cos(turn) - ray[2] * Math.sin(turn)
  const above = (ray[1] - dot * middle[1]) / Math.cos(height0)
  return [Math.acos(Math.min(dot, 1)) / radians(1), Math.atan2(-across, above) / radians(1)]
}

/**
 * Degrees of a ring in a picture: of arcs on which its band has more of what it has than either side. Arcs on which it has less than
 * both are taken off: where there is no ring, there are as many of these. Arcs hidden by the ground or outside of the picture do not count.
 */
export function degreesOf(ring: Ring, picture: PNG, view: RingView): number {
  const bands = [ring.band, ...ring.sides]
  /** Sums of what the ring has, and counts, of the bands by arcs. */
  const arcs = Array.from({ length: 360 / ARC }, () => bands.map(() => [0, 0]))
  for (let y = 0; y < picture.height; y++)
    for (let x = 0; x < picture.width; x++) {
      const [away, around] = aroundMiddle(ring, view, picture, x, y)
      const band = bands.findIndex(([from, to]) => away >= from && away < to)
      if (band < 0) continue
      const sums = arcs[Math.floor((around + 180) / ARC) % arcs.length][band]
      const pixel = 4 * (y * picture.width + x)
      const [red, green, blue] = picture.data.subarray(pixel, pixel + 3)
      sums[0] += ring.has === 'red' ? red - blue : (red + green + blue) / 3
      sums[1]++
    }
  let found = 0
  for (const arc of arcs) {
    if (arc.some(([, count]) => count < LEAST)) continue
    const [own, ...sides] = arc.map(([sum, count]) => sum / count)
    if (own - Math.max(...sides) > SEEN) found += ARC
    if (Math.min(...sides) - own > SEEN) found -= ARC
  }
  return Math.max(found, 0)
}
