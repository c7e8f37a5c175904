import { Matrix3, Matrix4, Vector3 } from 'three'
import { checkRange } from '@welkin/atmosphere'
import { checkNonNegative, checkPositive, checkVector, fail, setOptions } from '@welkin/geo'
import type { Ground } from '../rays/Ground'
import { figureOf, worldToGround } from '../tiles/cpu/figure'
import { Footing } from './Footing'

/** Options of {@link Walker}. */
export interface WalkerOptions {
  /** Height of the eyes above the feet, > 0, default 1.7 [m]. */
  eyeHeight?: number
  /** Speed of walking along the ground, ≥ 0, default 3 [m/s]. */
  speed?: number
  /** Speed off the ground, ≥ 0, default 4.2: a jump of 0.9 m on Earth [m/s]. */
  jumpSpeed?: number
  /** Acceleration of falls and slides, > 0, default 9.81 [m/s²]. */
  gravity?: number
  /** Slope on which feet hold, in [5, 80], default 45 [°]. */
  steepest?: number
}

/** State of a {@link Walker}. */
export type WalkerState = 'standing' | 'sliding' | 'falling' | 'swimming'

const SETTINGS = ['eyeHeight', 'speed', 'jumpSpeed', 'gravity', 'steepest'] as const

const DEFAULTS: Required<WalkerOptions> = {
  eyeHeight: 1.7,
  speed: 3,
  jumpSpeed: 4.2,
  gravity: 9.81,
  steepest: 45
}

/** Longest step of the integration, and longest time that one update counts [s]. */
const STEP = 1 / 60
const LONGEST_UPDATE = 1

/** Time constants of the horizontal speed: on the ground, in water and in the air [s]. */
const EASE = { standing: 0.1, swimming: 0.35, falling: 2 } as const

/** Friction of a slide, per tangent of the steepest slope that feet hold on [–]. */
const SLIDING_FRICTION = 0.6

/** Share of the eyes' height that is under water when one floats, and of the speed that is left then [–]. */
const AFLOAT = 0.85
const SWIMMING = 0.4

/** Frequency of the rise to the surface, critically damped [rad/s]. */
const BUOYANCY = 3

/** Height over the ground at which feet that are put there stand on it [m]. */
const ON_GROUND = 0.01

/** Drop of the ground in a step from which on feet leave it: so much [m], plus so many times the steepest slope over the step [–]. */
const LEAVING = 0.03
const LEAVING_SLOPES = 2

const wish = new Vector3()
const way = new Vector3()
const point = new Vector3()
const axes = new Matrix3()
const ecefToWorld = new Matrix4()

/**
 * Someone on foot: walks, jumps, falls, slides down what is too steep, wades and swims. On the CPU, in float64, and
 * much the same at any rate of frames: steps are of 1/60 s or less, and exact where nothing is touched.
 *
 * ```ts
 * const walker = new Walker(terrain).moveTo(camera.position)
 * // each frame:
 * camera.getWorldDirection(direction).multiplyScalar(forward) // −1 to 1, by keys
 * walker.update(direction, isSpacePressed, seconds)
 * walker.eyePosition(camera.position)
 * ```
 */
export class Walker {
  /** Ground under it, shared: a `Terrain`. */
  readonly ground: Ground
  /** Level part of the velocity, ECEF axes [m/s]. */
  readonly levelVelocity = new Vector3()
  /** Speed upward in the air and in water [m/s]. */
  verticalSpeed = 0
  #height = 0
  #state: WalkerState = 'falling'
  #eyeHeight = 0
  #speed = 0
  #jumpSpeed = 0
  #gravity = 0
  #steepest = 0
  readonly #here: Footing
  readonly #there: Footing

  /**
   * Someone who stands at longitude and latitude 0°, or the origin of a flat world, until `moveTo`.
   *
   * @throws If the ground is missing, or an option is unknown or out of its range.
   */
  constructor(ground: Ground, options: WalkerOptions = {}) {
    const isGround = typeof ground?.source?.sampleAt === 'function' && 'seaLevel' in ground
    if (!isGround) fail('Walker', 'ground must be a Terrain', ground)
    this.ground = ground
    this.#here = new Footing(ground)
    this.#there = new Footing(ground)
    this.set(DEFAULTS).set(options)
    const { flat, ellipsoid } = ground.atmosphere
    const start = flat ? new Vector3() : ellipsoid.geodeticToECEF({ longitude: 0, latitude: 0 })
    this.#place(start, 0)
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or out of its range; then nothing has changed.
   */
  set(settings: WalkerOptions): this {
    return setOptions('Walker', this, settings, ...SETTINGS)
  }

  /** Height of the eyes above the feet, > 0 [m]. */
  get eyeHeight(): number {
    return this.#eyeHeight
  }

  set eyeHeight(value: number) {
    checkPositive('Walker', 'eyeHeight', value)
    this.#eyeHeight = value
  }

  /** Speed of walking along the ground, ≥ 0 [m/s]. */
  get speed(): number {
    return this.#speed
  }

  set speed(value: number) {
    checkNonNegative('Walker', 'speed', value)
    this.#speed = value
  }

  /** Speed off the ground, ≥ 0 [m/s]. */
  get jumpSpeed(): number {
    return this.#jumpSpeed
  }

  set jumpSpeed(value: number) {
    checkNonNegative('Walker', 'jumpSpeed', value)
    this.#jumpSpeed = value
  }

  /** Acceleration of falls and slides, > 0 [m/s²]. */
  get gravity(): number {
    return this.#gravity
  }

  set gravity(value: number) {
    checkPositive('Walker', 'gravity', value)
    this.#gravity = value
  }

  /** Slope on which feet hold, in [5, 80] [°]. */
  get steepest(): number {
    return this.#steepest
  }

  set steepest(value: number) {
    checkRange('Walker', 'steepest', value, 5, 80)
    this.#steepest = value
  }

  /** On the ground, on too steep a slope, in the air or in water. */
  get state(): WalkerState {
    return this.#state
  }

  /** Height of the feet above the ellipsoid [m]. */
  get height(): number {
    return this.#height
  }

  /**
   * Puts the eyes at a point of the world, or above it where the feet would be in the ground, at rest.
   *
   * @param eye - World [units].
   * @throws If a component is not finite.
   */
  moveTo(eye: Vector3): this {
    checkVector('Walker.moveTo', 'eye', eye)
    const { atmosphere } = this.ground
    point.copy(eye).applyMatrix4(worldToGround(atmosphere))
    this.#place(point, figureOf(atmosphere).heightAt(point) - this.#eyeHeight)
    return this
  }

  /** Position of the eyes in the world, wherever that is on the planet by now [units]. */
  eyePosition(target: Vector3): Vector3 {
    const { subpoint, up } = this.#here
    ecefToWorld.copy(worldToGround(this.ground.atmosphere)).invert()
    target.copy(subpoint).addScaledVector(up, this.#height + this.#eyeHeight)
    return target.applyMatrix4(ecefToWorld)
  }

  /**
   * Advances by some time.
   *
   * @param direction - Direction to walk in, world axes: its level part counts, up to a length of 1 for the full speed.
   * @param isJumping - True while a jump is asked for.
   * @param seconds - Time since the last update, ≥ 0; no more than 1 s counts.
   * @throws If a value is not finite.
   */
  update(direction: Vector3, isJumping: boolean, seconds: number): void {
    checkVector('Walker.update', 'direction', direction)
    checkNonNegative('Walker.update', 'seconds', seconds)
    const time = Math.min(seconds, LONGEST_UPDATE)
    const steps = Math.ceil(time / STEP - 1e-9)
    axes.setFromMatrix4(worldToGround(this.ground.atmosphere))
    const length = direction.length()
    for (let i = 0; i < steps; i++) {
      const { up } = this.#here
      wish.copy(direction).applyMatrix3(axes).setLength(length)
      wish.addScaledVector(up, -wish.dot(up)).clampLength(0, 1)
      this.#step(isJumping, time / steps)
    }
  }

  #place(positionECEF: Vector3, height: number): void {
    const { floor } = this.#here.at(positionECEF)
    this.#height = height < floor + ON_GROUND ? floor : height
    this.levelVelocity.setScalar(0)
    this.verticalSpeed = 0
    this.#settle()
  }

  /** Tangent of the steepest slope. */
  get #tangent(): number {
    return Math.tan((this.#steepest * Math.PI) / 180)
  }

  /** Height of the feet of someone afloat [m]. */
  get #floatHeight(): number {
    return this.#here.water - AFLOAT * this.#eyeHeight
  }

  /** Finds the state from the height over the ground; on it there is no speed upward. */
  #settle(): void {
    const { floor, slope } = this.#here
    const isDeep = this.#floatHeight > floor && this.#height < this.#here.water
    if (isDeep) this.#state = 'swimming'
    else if (this.#height > floor) this.#state = 'falling'
    else {
      this.#state = slope > this.#tangent ? 'sliding' : 'standing'
      this.verticalSpeed = 0
    }
  }

  #step(isJumping: boolean, seconds: number): void {
    if (isJumping && this.#state === 'standing' && this.#jumpSpeed > 0) {
      this.#state = 'falling'
      this.verticalSpeed = this.#jumpSpeed
    }
    const here = this.#here
    if (this.#state === 'sliding') this.#slide(seconds)
    else this.#stride(EASE[this.#state], seconds)
    this.#avoidCliffs()
    const { up } = here
    const distance = way.length()
    here.copy(this.#there)
    this.#rise(distance, seconds)
    // Level with the ground there, as fast as before.
    const speed = this.levelVelocity.length()
    this.levelVelocity.addScaledVector(up, -this.levelVelocity.dot(up)).setLength(speed)
    this.#settle()
  }

  /** Eases the velocity to the wished one, and leaves the displacement in `way`: exact for a wish that stays. */
  #stride(ease: number, seconds: number): void {
    const { gradient } = this.#here
    const velocity = this.levelVelocity
    const isFree = this.#state === 'falling'
    const depth = (this.#here.water - this.#height) / (AFLOAT * this.#eyeHeight)
    const wading = 1 - (1 - SWIMMING) * Math.min(Math.max(depth, 0), 1)
    const length = wish.length()
    const climb = this.#state === 'standing' && length > 0 ? wish.dot(gradient) / length : 0
    // In the air the velocity stays, unless another one is wished for.
    if (isFree && length === 0) way.copy(velocity).multiplyScalar(seconds)
    else {
      wish.multiplyScalar((this.#speed * wading) / Math.hypot(1, climb))
      const rest = Math.exp(-seconds / ease)
      velocity.sub(wish)
      way
        .copy(wish)
        .multiplyScalar(seconds)
        .addScaledVector(velocity, ease * (1 - rest))
      velocity.multiplyScalar(rest).add(wish)
    }
  }

  /** Slides down by gravity against friction; leaves the displacement in `way`. */
  #slide(seconds: number): void {
    const { gradient, slope } = this.#here
    const velocity = this.levelVelocity
    const pull = (this.#gravity * seconds) / (1 + slope ** 2)
    way.copy(velocity)
    velocity.addScaledVector(gradient, -pull)
    const speed = velocity.length()
    velocity.setLength(Math.max(speed - SLIDING_FRICTION * this.#tangent * pull, 0))
    way.add(velocity).multiplyScalar(seconds / 2)
  }

  /** Takes from displacement and velocity the part that leads up too steep a slope, and finds the ground at the end. */
  #avoidCliffs(): void {
    for (let i = 0; i < 3; i++) {
      const there = this.#there.at(point.copy(this.#here.subpoint).add(way))
      const uphill = way.dot(there.gradient)
      const isOpen = uphill <= 0 || there.slope <= this.#tangent || there.floor < this.#height
      if (isOpen) return
      const square = there.gradient.lengthSq()
      way.addScaledVector(there.gradient, -uphill / square)
      const climbing = Math.max(this.levelVelocity.dot(there.gradient), 0)
      this.levelVelocity.addScaledVector(there.gradient, -climbing / square)
    }
    way.setScalar(0)
    this.levelVelocity.setScalar(0)
    this.#there.copy(this.#here)
  }

  /** Height of the feet after a step of some length, by the ground, gravity or water. */
  #rise(distance: number, seconds: number): void {
    const { floor } = this.#here
    const gravity = this.#gravity
    if (this.#state === 'swimming') {
      // Critically damped about the height at which one floats.
      const level = this.#floatHeight
      const above = this.#height - level
      const rate = this.verticalSpeed + BUOYANCY * above
      const decay = Math.exp(-BUOYANCY * seconds)
      this.#height = level + (above + rate * seconds) * decay
      this.verticalSpeed = (this.verticalSpeed - BUOYANCY * rate * seconds) * decay
    } else {
      const drop = this.#height - floor
      const isOff = drop > LEAVING + LEAVING_SLOPES * this.#tangent * distance
      if (this.#state === 'falling' || isOff) {
        this.#height += this.verticalSpeed * seconds - (gravity / 2) * seconds ** 2
        this.verticalSpeed -= gravity * seconds
      } else this.#height = floor
    }
    this.#height = Math.max(this.#height, floor)
  }
}
