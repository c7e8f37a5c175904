import { exp, float, fwidth, hash, sin, smoothstep, vec2 } from 'three/tsl'
import type { Float, Vec2 } from '../../tsl-types'

/** Side of a cell in which one drop falls per period [m], and the period [s]. */
const CELL = 0.24
const PERIOD = 0.6
/** Layers of cells, each shifted: rings overlap. */
const LAYERS = 3
/** Speed of rings: capillary–gravity waves are never slower (Lamb 1932, ch. IX) [m/s]. */
const SPEED = 0.23
/** Length of their waves: that of the slowest [m]. */
const WAVELENGTH = 0.017
/** Slope of the waves of a new ring [–]. */
const STEEPNESS = 0.35
/** Mean square of a ring's waves over its cell and period, over that of `STEEPNESS`: integrated numerically. */
const MEAN_SQUARE = 0.0072

/** Chance that a cell has a ring, without its bound of 1. */
const chanceOf = (ringRate: Float): Float => ringRate.mul((CELL * CELL * PERIOD) / LAYERS)

/**
 * Part of the ripples' slope that is left in the mean over a pixel, in [0, 1]: a wave of k radians a metre keeps exp(−k²σ²/2), σ² the variance
 * of places in the pixel along it, in the mean over directions. To be called out of branches.
 *
 * @param place - On the water [m].
 */
export function seenRipples(place: Vec2): Float {
  const width = (fwidth(place) as unknown as Vec2).toConst()
  // A width w has w²/12; half of the sum along both axes is the mean over directions.
  return width
    .dot(width)
    .mul(-(((2 * Math.PI) / WAVELENGTH) ** 2) / 48)
    .exp()
}

/** Variance of the ripples' slope along each axis [–]. @param ringRate - As for {@link rippleSlope}. */
export const rippleVariance = (ringRate: Float): Float =>
  chanceOf(ringRate)
    .min(1)
    .mul((LAYERS * STEEPNESS ** 2 * MEAN_SQUARE) / 2)

/**
 * Slope of ring waves that drops leave on water, along two axes [–].
 *
 * Each cell of a layer has at most one ring at a time, at a new place in every period.
 *
 * @param place - On the water [m].
 * @param time - Time [s].
 * @param ringRate - Drops that make rings [1/(m² s)]; more than 86 look like 86.
 */
export function rippleSlope(place: Vec2, time: Float, ringRate: Float): Vec2 {
  const chance = chanceOf(ringRate).toConst()
  let slope: Vec2 = vec2(0)
  for (let layer = 0; layer < LAYERS; layer++) {
    const shifted = place.div(CELL).add(vec2(0.37 * layer, 0.61 * layer))
    const cell = shifted.floor().toConst() as Vec2
    // Whole numbers up to 4096 make seeds that 32-bit floats hold.
    const wrapped = cell.mod(1024).toConst() as Vec2
    const own = wrapped.x.add(wrapped.y.mul(1024)).add(layer * 1_048_576)
    const clock = time.div(PERIOD).add(hash(own)).toConst() as Float
    const turn = clock.floor().mod(512).toConst() as Float
    const random = (n: number): Float => hash(own.add(turn.mul(7919)).add(n * 104_729))
    const age = clock.fract().toConst() as Float
    // A ring ends at its cell's edge: it has grown to its middle's distance from it, at most.
    const middle = vec2(random(1), random(2)).mul(0.3).add(0.35)
    const offset = shifted.sub(cell).sub(middle).mul(CELL).toConst() as Vec2
    const distance = offset.length().toConst() as Float
    const behind = distance.sub(age.mul(SPEED * PERIOD)).toConst() as Float
    const packet = exp(behind.mul(behind).mul(-1 / (WAVELENGTH * WAVELENGTH)))
    const fade = age.oneMinus().mul(smoothstep(CELL * 0.3, CELL * 0.2, distance))
    const wave = sin(behind.mul((2 * Math.PI) / WAVELENGTH))
      .mul(packet)
      .mul(fade)
    const isThere = random(0).lessThan(chance).select(float(STEEPNESS), float(0))
    slope = slope.add(offset.div(distance.max(1e-4)).mul(wave).mul(isThere))
  }
  return slope
}
