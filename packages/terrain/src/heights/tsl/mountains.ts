import { Break, Fn, If, float, smoothstep, vec4 } from 'three/tsl'
import { fractalSum, keptShare } from '../../noise/tsl/fractalSum'
import { latticeNoise } from '../../noise/tsl/latticeNoise'
import { layout, loop, type Float, type Vec3, type Vec4 } from '../../tsl-types'
import {
  BELT_RIDGES,
  CHAINS,
  COASTAL,
  COASTAL_RIDGES,
  CONTINENTS,
  CRAGS,
  CRAG_ROUGHENING,
  FOOTHILLS,
  HILLS,
  HILLS_END,
  HILLS_START,
  LAND_HEIGHT,
  LAND_OFFSET,
  LAND_WARP,
  LONG,
  MEAN_RIDGE,
  PLAINS,
  RIDGES,
  RIDGE_WARP,
  ROUGHENING,
  ROUNDNESS,
  SHORT,
  SHORT_CHAINS,
  SOFT,
  STEEPNESS,
  UPLIFT,
  type Belts
} from '../cpu/mountains'
import { warped, type Warped } from './warped'

const continents = /*#__PURE__*/ fractalSum('welkinContinents', CONTINENTS)

/**
 * Ridged multifractal: valleys and crests where noise is 0, each octave as rough as those before are high. The longer octaves are of the
 * displaced place. Parameters and result as of `fractalSum`.
 *
 * @see Ebert et al. 2003, "Texturing and Modeling", chapter 16, ridged multifractal. Twin: ../cpu/mountains.ts
 */
const ridgedSum = /*#__PURE__*/ Fn(
  ([reference, offset, shortest, seed]: [Vec3, Vec3, Float, Float]) => {
    const place = warped(RIDGE_WARP, reference, offset, shortest, seed)
    const sum = vec4(0).toVar()
    /** Weight of the octave (w) and its gradient. */
    const weight = vec4(0, 0, 0, 1).toVar()
    const inverse = float(RIDGES.inverse).toVar()
    const long = float(LONG[0]).toVar()
    const short = float(SHORT[0]).toVar()
    const soft = float(SOFT[0]).toVar()
    loop('octave', RIDGES.count, octave => {
      const kept = keptShare(inverse, shortest).div(long.add(short).add(soft)).toConst()
      If(kept.lessThanEqual(0), () => {
        Break()
      })
      const index = seed.add(float(octave)).add(RIDGES.seed)
      const isMoved = float(octave).lessThan(RIDGES.moved - 0.5)
      const where = isMoved.select(place.offset, offset).toConst() as Vec3
      const plain = latticeNoise(reference, where, inverse, index).mul(STEEPNESS).toConst()
      const noise = isMoved.select(place.back(plain), plain).toConst() as Vec4
      const root = noise.w
        .mul(noise.w)
        .add(ROUNDNESS ** 2)
        .sqrt()
        .toConst()
      const fall = root.oneMinus().toConst()
      const isValley = float(octave)
        .lessThan(RIDGES.valleys - 0.5)
        .select(1, 0)
        .toConst() as unknown as Float
      const sign = isValley.mul(-2).add(1).toConst()
      const ridge = fall.mul(fall).mul(sign).add(isValley).toConst()
      const steepness = fall.mul(noise.w).mul(inverse).mul(sign).mul(-2).div(root)
      // Product rule, gradients in xyz.
      const slope = noise.xyz.mul(steepness).mul(weight.w).toConst()
      const over = ridge.sub(isValley.mul(1 - 2 * MEAN_RIDGE).add(MEAN_RIDGE)).toConst()
      const gradient = slope.add(weight.xyz.mul(over))
      sum.addAssign(vec4(gradient, over.mul(weight.w)).mul(kept))
      const roughening = float(octave)
        .lessThan(CRAGS - 0.5)
        .select(ROUGHENING, CRAG_ROUGHENING)
        .toConst() as unknown as Float
      const next = ridge.mul(weight.w).mul(roughening).min(1).toConst()
      const turn = slope.add(weight.xyz.mul(ridge)).mul(next.oneMinus().mul(roughening).mul(2))
      weight.assign(vec4(turn, next.mul(float(2).sub(next))))
      inverse.mulAssign(2)
      long.mulAssign(LONG[1])
      short.mulAssign(SHORT[1])
      soft.mulAssign(SOFT[1])
    })
    return sum
  },
  layout('welkinRidges', 'vec4', {
    reference: 'vec3',
    offset: 'vec3',
    shortest: 'float',
    seed: 'float'
  })
) as unknown as (reference: Vec3, offset: Vec3, shortest: Float, seed: Float) => Vec4

/** Strength of a family of belts (w) and its gradient (xyz) [1/m]. */
function beltsAt(belts: Belts, reference: Vec3, place: Warped, seed: Float): Vec4 {
  const { inverse, width, strength, start, end } = belts
  const noise = latticeNoise(
    reference,
    place.offset,
    float(inverse),
    seed.add(belts.seed)
  ).toConst()
  const ratio = noise.w.div(width).toConst()
  const fall = ratio.mul(ratio).add(1).reciprocal().toConst()
  const move = place.moves[belts.axis]
  const t = move.w
    .sub(start)
    .div(end - start)
    .clamp(0, 1)
    .toConst()
  const there = smoothstep(0, 1, t).mul(strength).toConst()
  const edge = t.mul(t.oneMinus()).mul((6 * strength) / (end - start))
  const square = fall.mul(fall).toConst()
  const turn = ratio
    .mul(square)
    .mul(fall)
    .mul(there)
    .mul((-4 * inverse) / width)
  const across = place.back(vec4(noise.xyz.mul(turn), square.mul(there)))
  return across.add(vec4(move.xyz.mul(square.mul(edge)), 0)).toConst()
}

/**
 * Height of continents, belts and ridges.
 *
 * @param reference - As of `latticeNoise`, like `offset`.
 * @param shortest - Shortest wavelength [m], see `HeightSource.sample`.
 * @param relief - Height of the highest ridges over the valleys [m].
 * @param seed - Added to all seeds.
 * @returns Gradient (xyz) [–] and height (w) [m]. Twin: ../cpu/mountains.ts
 */
export const mountains = (
  reference: Vec3,
  offset: Vec3,
  shortest: Float,
  relief: Float,
  seed: Float
): Vec4 => {
  const place = warped(LAND_WARP, reference, offset, shortest, seed)
  const land = place.back(continents(reference, place.offset, shortest, seed)).toConst()
  const belt = beltsAt(CHAINS, reference, place, seed)
  const short = beltsAt(SHORT_CHAINS, reference, place, seed)
  const ridges = ridgedSum(reference, offset, shortest, seed).toConst()
  const lift = belt.add(short).sub(belt.mul(short.w)).sub(short.mul(belt.w))
  const lifted = vec4(lift.xyz, belt.w.add(short.w).sub(belt.w.mul(short.w))).toConst()
  const t = land.w
    .sub(HILLS_START)
    .div(HILLS_END - HILLS_START)
    .clamp(0, 1)
    .toConst()
  const edge = t.mul(t.oneMinus()).mul((6 * HILLS) / (HILLS_END - HILLS_START))
  const rise = lifted.w.mul(1 - FOOTHILLS).toConst()
  const mask = smoothstep(0, 1, t)
    .mul(HILLS)
    .add(PLAINS)
    .add(lifted.w.mul(rise.add(FOOTHILLS)).mul(BELT_RIDGES))
    .toConst()
  const rugged = lifted.xyz.mul(rise.mul(2).add(FOOTHILLS).mul(BELT_RIDGES))
  const turn = land.xyz.mul(edge).add(rugged).mul(ridges.w)
  const mountain = vec4(ridges.xyz.mul(mask).add(turn), ridges.w.mul(mask)).mul(relief).toConst()
  const level = land
    .mul(LAND_HEIGHT)
    .add(lifted.mul(relief.mul(UPLIFT)))
    .add(vec4(0, 0, 0, LAND_OFFSET))
    .toConst()
  const [low, high] = COASTAL
  const inner = level.w
    .sub(low)
    .div(high - low)
    .clamp(0, 1)
    .toConst()
  const share = smoothstep(0, 1, inner)
    .mul(1 - COASTAL_RIDGES)
    .add(COASTAL_RIDGES)
  const sharePerLevel = inner.mul(inner.oneMinus()).mul((6 * (1 - COASTAL_RIDGES)) / (high - low))
  return level.add(mountain.mul(share)).add(vec4(level.xyz.mul(sharePerLevel).mul(mountain.w), 0))
}
