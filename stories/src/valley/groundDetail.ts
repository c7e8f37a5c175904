import type { Texture } from 'three'
import { Fn, If, positionWorld, texture, vec2, vec3 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { OCTAVES_SIDE } from '../octaves'

/** Widths over which noise of rock repeats [m]; heights of its cracks over it [m]. Layers of rock are flatter than wide. */
const CRACKS = [
  [1240, 11],
  [173, 1.9]
] as const
const LAYERED = 1.7

/** Pixels over which rock is blurred: its bumps are differences between pixels, of which sharp ones would be pepper. */
const BLURRED = 1.5

/** Reads along the longer side of a pixel's footprint on rock. One: walls seen from aside are smeared down their slopes. */
const PROBES = 2

/** Widths over which crowns, and clumps of grass elsewhere, repeat [m]. */
const CROWNED = 97
const CLUMPS = 71

/**
 * Normal of ground with grain on it (Mikkelsen 2010, "Bump mapping unparametrized surfaces").
 *
 * @param rise - Difference of the grain's height to the pixels at the right and below [m].
 */
export function grainNormal(
  normal: Node<'vec3'>,
  rise: Node<'vec2'>,
  { right, down }: Footprint
): Node<'vec3'> {
  const [first, second] = [down.cross(normal).toConst(), normal.cross(right).toConst()]
  const area = right.dot(first).toConst()
  const slope = first.mul(rise.x).add(second.mul(rise.y)).mul(area.sign())
  return normal.mul(area.abs()).sub(slope).normalize()
}

/** Ways on the ground from a pixel to its neighbours [m]. */
export interface Footprint {
  readonly right: Node<'vec3'>
  readonly down: Node<'vec3'>
}

/** Coordinates of noise that repeats after a period [m]: the plane is turned, for no two periods have a common multiple. */
export function turned({ x, z }: Node<'vec3'>, period: number): Node<'vec2'> {
  const [cos, sine] = [Math.cos(period), Math.sin(period)].map(t => t / period)
  const place = vec2(x, z)
  return vec2(place.dot(vec2(cos, sine)), place.dot(vec2(-sine, cos)))
}

/**
 * Level of detail of the ground's noise, for a texture without anisotropy: reads with derivatives take three times as long.
 *
 * @param across - Way in its coordinates to the pixel at the right.
 * @param along - Way to the pixel below.
 */
export const levelOf = (across: Node<'vec2'>, along: Node<'vec2'>): Node<'float'> =>
  across
    .dot(across)
    .max(along.dot(along))
    .mul(OCTAVES_SIDE ** 2)
    .log2()
    .mul(0.5)
    .toConst()

/**
 * Crowns in woods, clumps of grass elsewhere: height about 0, and for crowns its differences to the pixels at the right and below, since those
 * between neighbours would be blocks of four pixels.
 *
 * @param isNear - False where they are too far away to be drawn: 0 there.
 */
export const clumpsIn = (
  picture: Texture,
  isNear: Node<'bool'>,
  isWood: Node<'bool'>,
  { right, down }: Footprint
): Node<'vec3'> =>
  Fn(() => {
    const found = vec3(0).toVar()
    const placed = (period: number): Node<'vec2'>[] =>
      [positionWorld, right, down].map(way => turned(way, period).toConst())
    If(isNear.and(isWood), () => {
      const [at, across, along] = placed(CROWNED)
      const level = levelOf(across, along)
      const heightAt = (place: Node<'vec2'>): Node<'float'> =>
        texture(picture, place).level(level).g.sub(0.5).mul(2)
      const here = heightAt(at).toConst()
      found.assign(
        vec3(here, heightAt(at.add(across)).sub(here), heightAt(at.add(along)).sub(here))
      )
    }).ElseIf(isNear, () => {
      const [at, across, along] = placed(CLUMPS)
      found.x.assign(texture(picture, at).level(levelOf(across, along)).r.sub(0.5).mul(2))
    })
    return found
  })()

/**
 * Noise of rock, seen from the side: from above, steep slopes would have streaks. Height of cracks [m], and their brightness in [−1, 1].
 *
 * @param isEastern - True for walls that face east or west rather than north or south.
 */
export function cracksIn(
  picture: Texture,
  isEastern: Node<'bool'>,
  { right, down }: Footprint
): Node<'vec2'> {
  const flat = (at: Node<'vec3'>): Node<'vec2'> =>
    vec2(isEastern.select(at.z, at.x), at.y.mul(LAYERED)).toConst()
  const [place, across, along] = [flat(positionWorld), flat(right), flat(down)]
  let sum: Node<'vec2'> = vec2(0)
  const [right2, down2] = [across, along].map(each => each.dot(each).toConst())
  const longer = right2.greaterThan(down2).select(across, along).mul(BLURRED).toConst()
  const width = right2
    .min(down2)
    .max(right2.max(down2).div(PROBES ** 2))
    .sqrt()
    .mul(BLURRED)
  for (const [period, deep] of CRACKS) {
    const at = place.div(period).toConst()
    const level = width
      .mul(OCTAVES_SIDE / period)
      .log2()
      .toConst() as Node<'float'>
    const probe = (part: number): Node<'float'> =>
      texture(picture, at.add(longer.mul(part / period))).level(level).r
    const noise = probe(-0.25).add(probe(0.25)).sub(1).toConst()
    // Cracks are sharp, what is between them is round.
    const cracked = noise.abs().mul(1.6).min(1).sub(0.4).toConst()
    sum = sum.add(vec2(cracked.mul(deep), cracked.add(noise.mul(0.5))))
  }
  return sum
}
