/** Height of the eyes above the feet [m]. */
export const EYE_HEIGHT = 1.7
/** [m/s²] */
const GRAVITY = 9.81
/** Speed off the ground: a jump of 0.9 m [m/s]. */
const JUMP = 4.2
/** Height of a step that feet take, up or down [m]. */
const STEP = 0.6
/** Slope up which one may walk, rise over way. */
const STEEPEST = 1.5
/** Height above which one sinks by a share of it per second, not by gravity alone [m]. */
export const HIGH = 20
const SINKING = 1.5

/** Depth of the feet of one who floats, and share of the speed that is left there: the eyes are well above the water [m]. */
const AFLOAT = 1
const SWIMMING = 0.4
/** Depth of water from which on one cannot jump [m]. */
const DEEP = 0.5

/** Height of the feet of one who stands on the ground, or floats in deep water over it [m]. */
export const footing = (ground: number, water: number): number => Math.max(ground, water - AFLOAT)

/** Share of the speed that water leaves to one whose feet are at a height. @param feet - [m]. */
export const wading = (feet: number, water: number): number =>
  1 - (1 - SWIMMING) * Math.min(Math.max((water - feet) / AFLOAT, 0), 1)

/** True where water is too deep to jump out of. @param feet - [m]. */
export const isDeep = (feet: number, water: number): boolean => water - feet > DEEP

/** The vertical part of walking: gravity, jumps and the ground under the feet. */
export class Walk {
  /** True while the feet are on the ground. */
  isGrounded = false
  /** Upward speed [m/s]. */
  private rising = 0

  /**
   * Answers if the ground ahead is too high to step on.
   *
   * @param eye - Height of the eyes [m].
   * @param ground - Height of the ground ahead; NaN blocks nobody [m].
   * @param distance - Way to it [m].
   */
  isBlocked(eye: number, ground: number, distance: number): boolean {
    return ground - (eye - EYE_HEIGHT) > STEP + STEEPEST * distance
  }

  /**
   * Height of the eyes after some time [m].
   *
   * @param eye - Height of the eyes before [m].
   * @param ground - Height of the ground; NaN where none is known, and nobody falls there [m].
   */
  advance(eye: number, ground: number, isJumping: boolean, seconds: number): number {
    if (!Number.isFinite(ground)) return eye
    let feet = eye - EYE_HEIGHT
    if (this.isGrounded && isJumping) {
      this.rising = JUMP
      this.isGrounded = false
    } else if (this.isGrounded && feet - ground < STEP) {
      return ground + EYE_HEIGHT
    }
    const height = feet - ground
    feet += this.rising * seconds - (GRAVITY / 2) * seconds ** 2
    this.rising -= GRAVITY * seconds
    if (height > HIGH) feet = Math.min(feet, ground + height * Math.exp(-SINKING * seconds))
    this.isGrounded = feet <= ground
    if (this.isGrounded) {
      feet = ground
      this.rising = 0
    }
    return feet + EYE_HEIGHT
  }
}
