import type { Vector3 } from 'three'
import type { FlashKind } from './flashCurve'
import { normal, type Random } from './random'

/** A point, from where the flash meets the ground or would: east, north, up [m]. */
export type Point = readonly [number, number, number]

/** A straight piece of a channel. */
export interface ChannelPiece {
  readonly from: Point
  readonly to: Point
  /** Its light per length over the stem's [–]. */
  readonly brightness: number
  readonly isBranch: boolean
}

/** A branched channel. */
export interface Channel {
  readonly pieces: readonly ChannelPiece[]
  /** Stem at even distances: what light in clouds comes from. */
  readonly stem: readonly Point[]
  /** Length of all pieces, each by its brightness [m]. */
  readonly brightLength: number
}

/** Light of a channel as colour: that of a body of 20,000 K, of luminance 1, linear sRGB (Orville 1968, J. Atmos. Sci. 25, 852: 20,000 to 30,000 K). */
export const CHANNEL_COLOR = [0.747, 0.99, 1.844] as const

/** A flash as it stands in the planet's mapped space. */
export interface PlacedChannel extends Channel {
  /** Foot on the ground, real or below a flash in the cloud, from the planet's centre [m]. */
  readonly place: Vector3
  /** East, north and up there. */
  readonly axes: readonly [Vector3, Vector3, Vector3]
}

/** Extent of a storm's cloud at the flash, above the ground [m]. */
export interface StormColumn {
  readonly base: number
  readonly top: number
}

/** Displacement of a channel's point from the camera, in the mapped space [m]. */
export function fromCamera(
  { place, axes }: Pick<PlacedChannel, 'place' | 'axes'>,
  viewpoint: Vector3,
  point: Point,
  target: Vector3
): Vector3 {
  target.copy(place).sub(viewpoint)
  point.forEach((value, axis) => target.addScaledVector(axes[axis], value))
  return target
}

/** Power for which half floats hold light: 1e-9 of it is left 2 km from the channel [lm]. */
export const STORED_POWER = 1e9

/** Points of {@link Channel.stem}. */
export const STEM_POINTS = 5

/** Length down to which a channel is crooked [m]. */
const FINEST = 35
/** Displacement of a middle over the length: directions change by 16° in the mean (Hill 1968, J. Geophys. Res. 73, 1897). */
const CROOKED = 0.063
/** Turn of branches from where they leave [rad], and their light over that of what they leave. */
const BRANCH_TURN = 0.6
const BRANCH_LIGHT = 0.35

/** Share of the cloud's depth between its charges, from the base: negative below, positive above (Krehbiel 1986). */
const NEGATIVE = 0.42
const POSITIVE = 0.75

const along = (a: Point, b: Point, t: number): Point => [
  a[0] + (b[0] - a[0]) * t,
  a[1] + (b[1] - a[1]) * t,
  a[2] + (b[2] - a[2]) * t
]
const distance = (a: Point, b: Point): number => Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2])

/** A crooked line between two points, ends included: middles are displaced in proportion to length, as in a fractal. */
export function crookedLine(from: Point, to: Point, random: Random): Point[] {
  let points: Point[] = [from, to]
  let length = distance(from, to)
  for (; length > FINEST; length /= 2) {
    const shift = CROOKED * length
    points = points.flatMap((point, i) => {
      if (i === 0) return [point]
      const [x, y, z] = along(points[i - 1], point, 0.5)
      const moved = [x, y, z].map(v => v + shift * normal(random))
      return [[moved[0], moved[1], Math.max(moved[2], 1)] as Point, point]
    })
  }
  return points
}

/** Channel of a flash: a stem that forks, downwards and outwards. */
export function lightningChannel(
  kind: FlashKind,
  { base, top }: StormColumn,
  random: Random
): Channel {
  const depth = top - base
  const pieces: ChannelPiece[] = []
  const add = (line: readonly Point[], brightness: number, order: number): void => {
    for (let i = 1; i < line.length; i++) {
      // Branches fade towards their tips.
      const left = order === 0 ? 1 : 1 - (i - 1) / line.length
      pieces.push({
        from: line[i - 1],
        to: line[i],
        brightness: brightness * left,
        isBranch: order > 0
      })
    }
    if (order === 2) return
    const length = distance(line[0], line[line.length - 1])
    const count = order === 0 ? 9 + Math.floor(5 * random()) : Math.floor(1 + 3 * random())
    for (let i = 0; i < count; i++) {
      const at = Math.floor((0.15 + 0.75 * random()) * (line.length - 1))
      const start = line[at]
      const next = line[Math.min(at + 4, line.length - 1)]
      const ahead = distance(start, next)
      if (ahead === 0) continue
      const reach = length * (0.12 + 0.28 * random()) * (1 - (0.5 * at) / line.length)
      const turned = [0, 1, 2].map(
        axis => (next[axis] - start[axis]) / ahead + BRANCH_TURN * normal(random)
      )
      const unit = reach / Math.hypot(...turned)
      const end: Point = [
        start[0] + turned[0] * unit,
        start[1] + turned[1] * unit,
        Math.max(start[2] + turned[2] * unit, 15)
      ]
      add(crookedLine(start, end, random), brightness * BRANCH_LIGHT, order + 1)
    }
  }
  const aside = (spread: number): [number, number] => [
    spread * normal(random),
    spread * normal(random)
  ]
  const negative: Point = [...aside(0.06 * depth), base + NEGATIVE * depth]
  const end: Point =
    kind === 'ground' ? [0, 0, 0] : [...aside(0.12 * depth), base + POSITIVE * depth]
  const stem = crookedLine(negative, end, random)
  add(stem, 1, 0)
  const points = Array.from(
    { length: STEM_POINTS },
    (_, i) => stem[Math.round((i / (STEM_POINTS - 1)) * (stem.length - 1))]
  )
  const brightLength = pieces.reduce(
    (sum, { from, to, brightness }) => sum + brightness * distance(from, to),
    0
  )
  return { pieces, stem: points, brightLength }
}
