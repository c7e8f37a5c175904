import { Break, Fn, If, float, smoothstep, vec3, vec4 } from 'three/tsl'
import { fractalSum, keptShare } from '../../noise/tsl/fractalSum'
import { latticeNoise } from '../../noise/tsl/latticeNoise'
import { layout, loop, type Float, type Vec3, type Vec4 } from '../../tsl-types'
import {
  CONTINENTS,
  LAND_HEIGHT,
  LAND_OFFSET,
  MEAN_RIDGE,
  PLAINS,
  RANGE_END,
  RANGE_START,
  RANGES,
  RIDGES,
  ROUGHENING,
  ROUNDNESS,
  STEEPNESS
} from '../cpu/mountains'

const continents = /*#__PURE__*/ fractalSum('welkinContinents', CONTINENTS)
const ranges = /*#__PURE__*/ fractalSum('welkinRanges', RANGES)

/**
 * Ridged multifractal: crests where noise is 0, each octave as rough as those before are high. Parameters and result
 * as of `fractalSum`.
 *
 * @see Ebert et al. 2003, "Texturing and Modeling", chapter 16, ridged multifractal. Twin: ../cpu/mountains.ts
 */
const ridgedSum = /*#__PURE__*/ Fn(
  ([reference, offset, shortest, seed]: [Vec3, Vec3, Float, Float]) => {
    const sum = vec4(0).toVar('sum')
    /** Weight of the octave (w) and its gradient. */
    const weight = vec4(0, 0, 0, 1).toVar('weight')
    const inverse = float(RIDGES.inverse).toVar('inverse')
    const amplitude = float(1).toVar('amplitude')
    loop('octave', RIDGES.count, octave => {
      const kept = keptShare(inverse, shortest).mul(amplitude).toConst('kept')
      If(kept.lessThanEqual(0), () => {
        Break()
      })
      const index = seed.add(float(octave)).add(RIDGES.seed)
      const noise = latticeNoise(reference, offset, inverse, index).mul(STEEPNESS).toConst('noise')
      const root = noise.w
        .mul(noise.w)
        .add(ROUNDNESS ** 2)
        .sqrt()
        .toConst('root')
      const fall = root.oneMinus().toConst('fall')
      const ridge = fall.mul(fall).toConst('ridge')
      const steepness = fall.mul(noise.w).mul(inverse).mul(-2).div(root)
      // Product rule, gradients in xyz.
      const slope = noise.xyz.mul(steepness).mul(weight.w).toConst('slope')
      const over = ridge.sub(MEAN_RIDGE)
      const gradient = slope.add(weight.xyz.mul(over))
      sum.addAssign(vec4(gradient, over.mul(weight.w)).mul(kept))
      const next = ridge.mul(weight.w).mul(ROUGHENING).min(1).toConst('next')
      const turn = slope.add(weight.xyz.mul(ridge)).mul(next.oneMinus().mul(2 * ROUGHENING))
      weight.assign(vec4(turn, next.mul(float(2).sub(next))))
      inverse.mulAssign(2)
      amplitude.mulAssign(RIDGES.gain)
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

/**
 * Height of continents, ranges and ridges.
 *
 * @param reference - As of `latticeNoise`, like `offset`.
 * @param shortest - Shortest wavelength [m], see `HeightSource.sample`.
 * @param relief - Height of the highest ridges over the land [m].
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
  const land = continents(reference, offset, shortest, seed).toConst('land')
  const range = ranges(reference, offset, shortest, seed).toConst('range')
  const ridges = ridgedSum(reference, offset, shortest, seed).toConst('ridges')
  const width = RANGE_END - RANGE_START
  const sum = land.add(range).toConst('sum')
  const t = sum.w.sub(RANGE_START).div(width).clamp(0, 1).toConst('t')
  const mask = smoothstep(0, 1, t)
    .mul(1 - PLAINS)
    .add(PLAINS)
    .toConst('mask')
  const edge = t.mul(t.oneMinus()).mul((6 * (1 - PLAINS)) / width)
  const tilt = vec3(ridges.xyz)
    .mul(mask)
    .add(sum.xyz.mul(edge.mul(ridges.w)))
  const mountain = vec4(tilt, ridges.w.mul(mask)).mul(relief)
  return land
    .mul(LAND_HEIGHT)
    .add(mountain)
    .add(vec4(0, 0, 0, LAND_OFFSET))
}
