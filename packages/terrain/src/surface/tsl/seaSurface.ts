import {
  Break,
  Fn,
  If,
  exp,
  float,
  mat3,
  mix,
  smoothstep,
  uniformArray,
  vec3,
  vec4
} from 'three/tsl'
import { Vector4 } from 'three'
import { loop, type Float, type Int, type Vec3, type Vec4 } from '../../tsl-types'
import { GRAVITY, PERIOD, SEA_WAVES, WARP, WARPED, WARPS, WAVE_SLOPE } from '../seaWaves'
import { gradientAlong } from './gradientAlong'
import { schlick } from './schlick'

/** Reflectance of deep clear water, linear sRGB: that of the sea of `planetGround`. */
const DEEP = [0.007, 0.022, 0.042] as const

/**
 * Extinction of clear water, linear sRGB [1/m]: absorption by pure water at 610, 550 and 465 nm, and 0.03 by what floats in it.
 *
 * @see Pope & Fry 1997, "Absorption spectrum (380–700 nm) of pure water", table 3
 */
const EXTINCTION = [0.294, 0.087, 0.04] as const

/** Path of light through water, down and up, per depth [–]: both are refracted towards the vertical. */
const PATH = 2.4

/** Depth at which water covers a pixel fully: at least so much [m], and so much of the differences of height within the pixel [–]. */
const SHALLOW = 0.12
const SHALLOW_SPREAD = 0.5

/** Size of a pixel beyond which no wave is kept [m]. */
export const LONGEST_KEPT = Math.max(...SEA_WAVES.map(({ length }) => length))

/** Reflectance of water at normal incidence, refractive index 1.34. */
export const WATER_FRESNEL = ((1.34 - 1) / (1.34 + 1)) ** 2

/** The sea at a pixel. */
export interface SeaSurface {
  /** Share of the pixel that is water, in [0, 1]. */
  readonly cover: Float
  /** Slopes of waves along the ground, ECEF axes [–]. */
  readonly slope: Vec3
  /** Variance of the slopes that the waves do not resolve. */
  readonly variance: Float
}

/** Change of the slopes' variance by the climate's noise [–]. 0: the sun's glint from orbit is without streaks of wind (*Terrain*). */
const WINDY = 0.9

/** Least variance of slopes over its mean: that of nearly calm water in light wind. */
const CALMEST = 0.25

/**
 * Variance of the sea's slopes at a place: wind differs over hundreds of kilometres, by the same noise as the climate of land.
 *
 * @param seaVariance - Variance in the mean wind.
 * @param climate - Noise about 0.
 */
export const windyVariance = (seaVariance: Float, climate: Float): Float =>
  seaVariance.mul(climate.mul(WINDY).add(1).max(CALMEST)).toConst()

/** A place of the sea. */
export interface SeaPlace {
  /** As of `latticeNoise`. */
  readonly offset: Vec3
  /** Depth of the ground below the surface; negative on land [m]. */
  readonly depth: Float
  /** Geodetic up, ECEF axes. */
  readonly up: Vec3
  /** Longer side of the pixel on the ground [m]. */
  readonly footprint: Float
  /** Differences of height within a pixel [m]. */
  readonly spread: Float
}

type Matrix = { mul(vector: Vec3): Vec3 }

type Variable = Vec4 & { assign(value: Vec4): void; addAssign(value: Vec4): void }

/**
 * Water and its waves. Twin: ../cpu/seaSurface.ts
 *
 * @param seaVariance - Variance of all slopes, see `seaSlopeVariance`.
 * @param seconds - Time that waves move by [s].
 * @param hasWaves - False where all pixels are larger than {@link LONGEST_KEPT}.
 */
export function seaSurface(
  place: SeaPlace,
  seaVariance: Float,
  seconds: Float,
  hasWaves = true
): SeaSurface {
  const { offset, depth, up, footprint, spread } = place
  const shallow = spread.mul(SHALLOW_SPREAD).max(SHALLOW)
  const cover = smoothstep(0, shallow, depth).toConst()
  const listed = SEA_WAVES.map(({ vector, frequency }) => new Vector4(...vector, frequency))
  const vectors = uniformArray(listed, 'vec4') as unknown as { element(index: Int): Vec4 }
  const waves = Fn(() => {
    const sum = vec4(0).toVar() as unknown as Variable
    const find = (): void => {
      const steepest = seaVariance.sqrt().mul(WAVE_SLOPE).toConst()
      const warp = mat3(...(WARPS.flat() as Parameters<typeof mat3>))
        .mul((2 * Math.PI) / PERIOD)
        .toConst() as unknown as Matrix
      const phases = warp.mul(offset).toConst()
      const warped = offset.add(phases.sin().mul(WARP)).toConst() as Vec3
      // A loop: where there is no sea, the code of its waves costs time, too.
      loop('wave', SEA_WAVES.length, wave => {
        const { xyz: vector, w: frequency } = vectors.element(wave).toConst() as Vec4
        // As their frequencies are those of deep water.
        const perLength = frequency
          .mul(frequency)
          .mul((2 * Math.PI) / GRAVITY)
          .toConst() as Float
        If(footprint.mul(perLength).greaterThan(1), () => {
          Break()
        })
        const periods = warped.dot(vector).div(PERIOD).sub(seconds.mul(frequency))
        const kept = footprint.mul(perLength).oneMinus().mul(steepest).toConst()
        const tilt = periods
          .fract()
          .mul(2 * Math.PI)
          .cos()
          .mul(kept)
        sum.addAssign(
          vec4(vector.mul(tilt.div(perLength.mul(PERIOD))), kept.mul(kept).mul(WARPED / 3))
        )
      })
      // Derivative of the warp, whose matrix is its own transpose.
      const turn = warp.mul(sum.xyz.mul(phases.cos()).mul(WARP))
      sum.assign(vec4(gradientAlong(sum.xyz.add(turn), up), sum.w))
    }
    // From afar no wave is kept.
    if (hasWaves) If(cover.greaterThan(0).and(footprint.lessThan(LONGEST_KEPT)), find)
    return sum
  })().toConst() as unknown as Vec4
  return { cover, slope: waves.xyz.mul(cover), variance: seaVariance.sub(waves.w) }
}

/**
 * Fresnel reflectance of rough water: at a mean slope.
 *
 * @param cosViewer - Cosine between normal and viewer.
 * @param variance - Variance of slopes.
 * @see Akenine-Möller et al. 2018, Real-Time Rendering, 4th ed., §9.5, after Schlick 1994. Twin: ../cpu/seaSurface.ts
 */
export function waterFresnel(cosViewer: Float, variance: Float): Float {
  const cosine = cosViewer.mul(cosViewer).add(variance).sqrt()
  return mix(float(WATER_FRESNEL), float(1), schlick(cosine))
}

/** Reflectance of foam. */
export const FOAM = 0.6

/** Depths between which foam lies at the water's edge, in and out of it [m], and how far it comes and goes [m]. */
const FOAM_DEPTHS = [0.02, 0.08, 0.14, 0.4] as const
const FOAM_SWAY = 0.07

/** Time in which it comes and goes [s], and size of a pixel at which there is none [m]. */
const FOAM_PERIOD = 7
export const FOAM_GONE = 3

/**
 * Share of foam at the water's edge, in [0, 1].
 *
 * @param tangle - Strands, about 0.
 * @param patch - Noise by which it comes and goes at other times elsewhere.
 * @param seconds - Time that waves move by [s].
 */
export function foamCover(
  { depth, footprint }: SeaPlace,
  tangle: Float,
  patch: Float,
  seconds: Float
): Float {
  const [a, b, c, d] = FOAM_DEPTHS
  const phase = seconds.div(FOAM_PERIOD).add(patch.mul(2)).fract()
  const sway = phase.mul(2 * Math.PI).sin()
  const swayed = depth.add(sway.mul(FOAM_SWAY)).toConst() as Float
  const band = smoothstep(a, b, swayed).mul(smoothstep(c, d, swayed).oneMinus())
  const lace = smoothstep(-0.12, 0.22, tangle.add(band.mul(0.1)))
  return band.mul(lace).mul(footprint.div(FOAM_GONE).oneMinus().max(0))
}

/**
 * Colour of water over its bed: light of the bed that the path through the water leaves, and that of deep water.
 *
 * @param depth - Depth of the water [m].
 */
export function waterColor(bed: Vec3, depth: Float): Vec3 {
  const left = exp(vec3(...EXTINCTION).mul(depth.max(0).mul(-PATH)))
  return mix(vec3(...DEEP), bed, left)
}
