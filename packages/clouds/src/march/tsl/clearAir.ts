import { If, exp2, float, int, vec2 } from 'three/tsl'
import { select } from '../../select'
import { SAME_DISTANCE } from '../../temporal/tsl/depthTest'
import { encodeDistance } from '../../temporal/tsl/packing'
import {
  loop,
  type Float,
  type LevelTexture,
  type Mat3,
  type Vec2,
  type Vec3,
  type Vec4
} from '../../tsl-types'
import { ROUND } from '../FrameUniforms'
import { FAR_AWAY } from './layerBoundaries'
import type { FrameInputs } from './viewRay'

// Clear air is where it was in the last frame: a ray begins at the first cloud that those around it have found, and one that
// met none in the last frame ends behind the clouds of its neighbours. Tiles of rays take turns to be marched whole, and find what is
// new; so are rays that were out of the picture, and all of them where clouds have changed.

/** Edge of a tile [rays]. Smaller: slower, since a GPU marches rays side by side together. */
const TILE = 16

/** Tiles that are marched whole in a frame are this many apart in a row, for each row between them. */
const ROW_SHIFT = 5

/**
 * Factors of the distances at which clouds were found: rays begin before the nearest and end behind the farthest.
 * Nearer to 1: faster, and edges are ragged in motion (*Cockpit*).
 */
const BEFORE = 0.97
const BEHIND = 1.1

/** Levels to an octave in which distances are kept, log₂ of the distance at the first [m], and the last. */
const PER_OCTAVE = 8
const FIRST = 3
const LAST = 125

/** Level of a ray that is clear to its end, beyond all others. */
const CLEAR = LAST + 1

/** Largest distance that is kept, beyond which a cloud is not told from none: layers that a ray enters there are marched whole [m]. */
export const FARTHEST_KNOWN = 2 ** (FIRST + LAST / PER_OCTAVE)

/** Steps over 256 are kept in as many parts. */
const STEPS = 7

/** Numbers of 11 bits, which half floats hold. */
const BITS = 2 ** 11

/** Clouds that a march has found on a ray. */
export interface FoundOnRay {
  /** Distance of the first cloud; 0 if there is none [m]. */
  readonly first: Float
  /** `ClearAir.until` of the ray [m]. */
  readonly until: Float
  /** Distance where it ends [m]. */
  readonly end: Float
  readonly steps: Float
}

/**
 * Distance at which a ray's clouds begin, rounded down, and its steps, as a number in [0, 1). A ray that met no cloud where it began
 * remembers that place: a small cloud is between its pixels.
 */
export function packFound({ first, until, end, steps }: FoundOnRay): Float {
  const isMemory = until.greaterThan(0).and(first.equal(0)).toConst()
  const begin = select(isMemory, until, select(first.greaterThan(0), first, end)) as Float
  const level = encodeDistance(begin).sub(FIRST).mul(PER_OCTAVE).floor().clamp(0, CLEAR)
  const code = level.mul(2).add(select(isMemory, 1, 0))
  const part = steps.div(256).min(1).mul(STEPS).round()
  return code
    .mul(STEPS + 1)
    .add(part)
    .div(BITS)
}

/**
 * The inverse of {@link packFound}.
 *
 * @returns A whole number that `clearAir` reads, and steps over 256.
 */
export function unpackFound(packed: Float): { code: Float; steps: Float } {
  const bits = packed.mul(BITS).round().toConst() as Float
  const code = bits
    .div(STEPS + 1)
    .floor()
    .toConst() as Float
  return { code, steps: bits.sub(code.mul(STEPS + 1)).div(STEPS) }
}

/** Air of a ray that was clear in the last frame. */
export interface ClearAir {
  /** Distance up to which it is clear; 0 where the ray is to be marched whole [m]. */
  readonly until: Float
  /** Distance from which on it is clear again, if the ray meets nothing before [m]. */
  readonly from: Float
}

/** Distance of a level [m]. */
const distanceOf = (level: Float): Float => exp2(level.div(PER_OCTAVE).add(FIRST))

/**
 * Clear air of a ray, by what the rays around it have found in the last frame. To be called inside of a shader function.
 *
 * @param last - Distances of the last frame's marched pixels: the second number is log₂ of where a ray ended, the third `unpackFound`'s code.
 * @param block - Block of the ray's pixel.
 * @param ndc - `PixelRay.ndc`.
 * @param end - Distance where the ray ends [m].
 */
export function clearAir(
  { frame }: FrameInputs,
  last: LevelTexture<Vec2>,
  block: Vec2,
  ndc: Vec3,
  end: Float
): ClearAir {
  const until = float(0).toVar()
  const from = float(FAR_AWAY).toVar()
  const tile = block.div(TILE).floor().toConst() as Vec2
  const turn = tile.x.add(tile.y.mul(ROW_SHIFT)).add(frame.turn).mod(ROUND).round()
  const clipped = (frame.raysBefore as unknown as Mat3).mul(ndc).toConst() as Vec3
  const before = clipped.xy.div(clipped.z.max(1e-9)).mul(vec2(0.5, -0.5)).add(0.5).toConst() as Vec2
  const isInside = before.clamp(vec2(0), vec2(1)).equal(before).all().and(clipped.z.greaterThan(0))
  If(isInside.and(turn.greaterThan(0)).and(frame.unsureUntil.lessThan(FAR_AWAY)), () => {
    const middle = before.mul(frame.size).div(frame.block).floor().toConst() as Vec2
    const nearest = float(CLEAR).toVar()
    const farthest = float(0).toVar()
    const wasClear = float(0).toVar()
    const ownEnd = encodeDistance(end).toConst() as Float
    loop('around', 9, index => {
      const aside = vec2(float(index.mod(3)), float(index.div(3))).sub(1)
      const pixel = middle.add(aside).clamp(vec2(0), frame.marchedSize.sub(1))
      const at = pixel.add(0.5).div(frame.marchedSize).toConst() as Vec2
      const { y: endBefore, z } = last.sample(at).level(0).toConst() as Vec4
      const code = z.round().toConst() as Float
      const level = code.div(2).floor().toConst() as Float
      const isMemory = code.greaterThan(level.mul(2)).toConst()
      const isClear = level.equal(CLEAR).toConst()
      const isOwn = index.equal(int(4)).toConst()
      // A place that a neighbour only remembers spreads no farther.
      If(isOwn.or(isMemory.not()), () => {
        nearest.assign(nearest.min(level))
        farthest.assign(farthest.max(select(isClear, 0, level)))
      })
      // A ray that ended before a wall knows nothing of the air behind it.
      const isAsFar = ownEnd.sub(endBefore).lessThan(SAME_DISTANCE)
      If(isOwn.and(isClear.or(isMemory)).and(isAsFar), () => {
        wasClear.assign(1)
      })
    })
    const begin = distanceOf(nearest)
      .mul(BEFORE)
      .sub(2 ** FIRST)
    until.assign(select(nearest.equal(CLEAR), FAR_AWAY, begin.max(0)))
    If(wasClear.greaterThan(0), () => {
      from.assign(distanceOf(farthest.add(1)).mul(BEHIND))
    })
  })
  return { until, from }
}
