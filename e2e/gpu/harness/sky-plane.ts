import type { PerspectiveCamera } from 'three'
import { Vector3 } from 'three'
import { powerSpectrum } from '../../validate/power-spectrum'
import type { Picture } from './picture'

/** A square of a cloud deck, above the ground in a world whose y axis is up [m]. */
export interface SkySquare {
  readonly altitude: number
  /** Centre, from below the camera. */
  readonly x: number
  readonly z: number
  readonly width: number
}

/** The place in a square that is the `i`-th of `size`². */
export function placeIn(square: SkySquare, size: number, i: number): [x: number, z: number] {
  const along = (step: number): number => ((step + 0.5) / size - 0.5) * square.width
  return [square.x + along(i % size), square.z + along(Math.floor(i / size))]
}

const EARTH_RADIUS = 6.371e6

const mix = (a: number, b: number, t: number): number => a + (b - a) * t

/** Square that a camera at the origin sees, straightened: `size`² brightnesses. */
export function straighten(
  picture: Picture,
  camera: PerspectiveCamera,
  square: SkySquare,
  size: number
): number[] {
  const { width, height } = picture
  const light = (x: number, y: number): number => {
    const [r, g, b] = picture.at(x, y)
    return r + g + b
  }
  return Array.from({ length: size ** 2 }, (_, i) => {
    const [x, z] = placeIn(square, size, i)
    const place = new Vector3(x, square.altitude - (x * x + z * z) / (2 * EARTH_RADIUS), z)
    place.project(camera)
    const [u, v] = [(0.5 + 0.5 * place.x) * width - 0.5, (0.5 - 0.5 * place.y) * height - 0.5]
    const [left, top] = [Math.floor(u), Math.floor(v)]
    if (!(left >= 0 && top >= 0 && left < width - 1 && top < height - 1)) {
      throw new Error(`straighten: the camera does not see ${x}, ${z}`)
    }
    return mix(
      mix(light(left, top), light(left + 1, top), u - left),
      mix(light(left, top + 1), light(left + 1, top + 1), u - left),
      v - top
    )
  })
}

/**
 * Contrasts against the mean light around, so that haze and the sun's glow do not count; by their
 * deviation, which comes along.
 */
export function contrasts(
  light: readonly number[],
  size: number,
  halfWidth: number
): { values: number[]; deviation: number } {
  const blurred = (values: readonly number[], stride: number): number[] =>
    values.map((_, i) => {
      const at = Math.floor(i / stride) % size
      const [first, last] = [Math.max(at - halfWidth, 0), Math.min(at + halfWidth, size - 1)]
      let sum = 0
      for (let j = first; j <= last; j++) sum += values[i + (j - at) * stride]
      return sum / (last - first + 1)
    })
  const about = blurred(blurred(light, 1), size)
  const raw = light.map((value, i) => value / about[i] - 1)
  const deviation = Math.sqrt(raw.reduce((sum, v) => sum + v * v, 0) / raw.length)
  // A few gaps in a deck are not to outshine all else.
  return { values: raw.map(v => Math.min(Math.max(v / deviation, -3), 3)), deviation }
}

/** Angle between two lines [rad]. */
function between(a: number, b: number): number {
  const turn = Math.abs(a - b) % Math.PI
  return Math.min(turn, Math.PI - turn)
}

/** Alignment of a picture's waves: how far they stand out from others of their length. */
export interface Alignment {
  /** The wave that stands out the most, and its power by the noise floor's. */
  readonly peak: { readonly ratio: number; readonly wave: readonly [number, number] }
  /** Mean power by the floor's of all waves along a direction, an angle from the first axis [rad]. */
  along: (angle: number) => number
}

/**
 * Looks for rows in a square picture. Light from a side and perspective draw out all that is seen, a
 * little: the noise floor of a wave is the mean of those that are as long and go some other way, but not
 * across.
 *
 * @param longest - Waves of at least so many to an edge of the picture are looked at.
 */
export function alignment(picture: readonly number[], size: number, longest: number): Alignment {
  const shortest = size / 4
  const width = (3 * Math.PI) / 180
  const power = powerSpectrum(picture, size)
  const waves = power.flatMap((p, i) => {
    const signed = (n: number): number => (n > size / 2 ? n - size : n)
    const wave: [number, number] = [signed(i % size), signed(Math.floor(i / size))]
    const count = Math.hypot(...wave)
    const isHalf = wave[1] > 0 || (wave[1] === 0 && wave[0] > 0)
    if (!isHalf || count < longest - 2 || count > shortest + 2) return []
    return [{ p, wave, count, angle: Math.atan2(wave[1], wave[0]) }]
  })
  const rings = new Map<number, typeof waves>()
  for (const wave of waves) {
    const ring = Math.round(wave.count)
    rings.set(ring, [...(rings.get(ring) ?? []), wave])
  }
  const ratios = waves
    .filter(({ count }) => count >= longest && count <= shortest)
    .map(wave => {
      const ring = Math.round(wave.count)
      let [sum, weight] = [0, 0]
      for (const other of [ring - 1, ring, ring + 1].flatMap(n => rings.get(n) ?? [])) {
        const angle = between(other.angle, wave.angle)
        if (angle < 3 * width || angle > Math.PI / 4) continue
        sum += other.p
        weight++
      }
      return { wave: wave.wave, angle: wave.angle, ratio: (wave.p * weight) / sum }
    })
  const peak = ratios.reduce((a, b) => (a.ratio > b.ratio ? a : b))
  return {
    peak,
    along(angle) {
      const near = ratios.filter(wave => between(wave.angle, angle) < width)
      return near.reduce((sum, { ratio }) => sum + ratio, 0) / near.length
    }
  }
}
