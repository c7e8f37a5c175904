import { floor, fract, mix, positionWorld, sin, smoothstep, vec3, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { VILLAGE } from './places'

/** Colours of fields, linear sRGB: hay, young corn, earth, clover, ripe corn. */
const CROPS = [
  [0.133, 0.15, 0.054],
  [0.066, 0.112, 0.034],
  [0.12, 0.096, 0.06],
  [0.1, 0.128, 0.045],
  [0.25, 0.192, 0.066]
] as const

/** Width of a strip of fields [m]. */
export const STRIP = 70

/** Length of a field [m], and that over its width. */
const LENGTH = 160
const LONG = LENGTH / STRIP

/** Distance between two furrows, and between the tracks of a farmer's wheels [m]. */
const FURROW = 2.6
const LANE = 17.5

/** Half width of the road from the village to the lake [m]. */
export const HALF_ROAD = 2.2

/** Parts of a strip's width by which its borders stray, and of the verge of grass between two fields, half of it. */
const STRAY = 0.012
const VERGE = 0.011

/** Part of a verge whose stalks snow does not cover. */
const STALKS = 0.22

/**
 * Fields in strips, with their furrows; grass in some, and on the verges between them. In alpha the part that snow does not cover.
 *
 * @param noise - Noise of clumps of grass, about in [−1, 1].
 */
export function crops(
  grass: Node<'vec3'>,
  distance: Node<'float'>,
  noise: Node<'float'>
): Node<'vec4'> {
  const { x, z } = positionWorld
  const across = x
    .div(STRIP)
    .add(sin(z.div(300)).mul(0.3))
    .toConst()
  const strayed = across.add(noise.mul(STRAY)).toConst()
  const strip = floor(strayed).toConst()
  const along = z.div(LENGTH).add(strip.mul(0.7)).toConst()
  const row = floor(along).toConst()
  const chance = fract(sin(strip.mul(127.1).add(row.mul(311.7))).mul(43.76)).toConst()
  let color = grass
  for (const [i, crop] of CROPS.entries()) {
    color = chance.greaterThan(0.4 + 0.13 * i).select(vec3(...crop), color)
  }
  // Furrows along the strips, until they are as fine as pixels; wheels leave their tracks in corn.
  const furrows = sin(across.mul((2 * Math.PI * STRIP) / FURROW)).mul(smoothstep(170, 40, distance))
  const aside = fract(across.mul(STRIP / LANE))
    .sub(0.5)
    .abs()
    .mul(LANE)
  const track = smoothstep(0.5, 0.2, aside.sub(0.9).abs()).mul(smoothstep(700, 250, distance))
  const border = fract(strayed)
    .sub(0.5)
    .abs()
    .max(
      fract(along)
        .sub(0.5)
        .abs()
        .mul(LONG)
        .sub(LONG / 2 - 0.5)
    )
  const verge = smoothstep(0.5 - 2 * VERGE, 0.5 - VERGE, border)
  const isCorn = chance.greaterThan(0.4).select(1, 0)
  const tilled = color.mul(furrows.mul(0.07).add(1).sub(track.mul(isCorn).mul(0.18)))
  return vec4(mix(tilled, grass.mul(0.8), verge), verge.mul(STALKS))
}

/** 1 on that road. Twin of the middle: `roadMiddle` of the ground. */
export function roadAt(): Node<'float'> {
  const { x, z } = positionWorld
  const middle = sin(z.div(95))
    .mul(14)
    .add(sin(z.div(310)).mul(38))
    .add(VILLAGE.x - 44)
  const isSouth = smoothstep(-300, -285, z)
  return smoothstep(HALF_ROAD + 0.6, HALF_ROAD - 0.4, x.sub(middle).abs()).mul(isSouth)
}
