import { MathUtils, Quaternion, Vector3 } from 'three'

/** Height that a flight gains on its way, over the distance. */
const RISE = 0.1

/** Angle of up from the direction that leads away from the origin, up to which a world is round about that [rad]: an ellipsoid has less. */
const ROUND = 0.01

/** Turn of up from which a flight goes around such a world [rad]. */
const LEAST_TURN = 1e-3

export interface FlightEnd {
  readonly position: Vector3
  readonly rotation: Quaternion
  /** Unit vector. */
  readonly up: Vector3
  /** Height above the datum [m]. */
  readonly height: number
}

/** Way around a world about the origin, with the shorter turn. */
class Arc {
  readonly #axis: Vector3
  readonly #angle: number
  readonly #start: Vector3
  readonly #lengths: readonly [number, number]
  readonly #rotation: Quaternion
  /** Rotation at the end, seen from the frame that was turned along. */
  readonly #turnedBack: Quaternion
  readonly #turn = new Quaternion()

  constructor(from: FlightEnd, to: FlightEnd) {
    this.#start = from.position.clone().normalize()
    this.#angle = from.position.angleTo(to.position)
    this.#axis = this.#start.clone().cross(to.position.clone().normalize())
    // To the antipodes, ahead.
    if (this.#axis.length() < 1e-6) {
      const ahead = new Vector3(0, 0.01, -1).applyQuaternion(from.rotation)
      this.#axis.crossVectors(this.#start, ahead)
    }
    this.#axis.normalize()
    this.#lengths = [from.position.length(), to.position.length()]
    this.#rotation = from.rotation
    const back = new Quaternion().setFromAxisAngle(this.#axis, -this.#angle)
    this.#turnedBack = back.multiply(to.rotation)
  }

  at(part: number, position: Vector3, rotation: Quaternion): void {
    this.#turn.setFromAxisAngle(this.#axis, this.#angle * part)
    position.copy(this.#start).applyQuaternion(this.#turn)
    position.multiplyScalar(MathUtils.lerp(...this.#lengths, part))
    rotation.slerpQuaternions(this.#rotation, this.#turnedBack, part).premultiply(this.#turn)
  }
}

/** A smooth flight between two views: in a straight line, or around a world whose middle is the origin. */
export class Flight {
  /** Settles the promise of whoever asked for the flight. */
  readonly end: () => void
  private readonly from: FlightEnd
  private readonly to: FlightEnd
  private readonly seconds: number
  private readonly rise: number
  private readonly arc: Arc | undefined
  private elapsed = 0

  /** @param seconds - Time that it takes, ≥ 0 [s]. */
  constructor(from: FlightEnd, to: FlightEnd, seconds: number, end: () => void) {
    this.from = from
    this.to = to
    this.seconds = seconds
    this.end = end
    this.rise = RISE * from.position.distanceTo(to.position)
    const isRound = [from, to].every(({ position, up }) => position.angleTo(up) < ROUND)
    if (isRound && from.up.angleTo(to.up) > LEAST_TURN) this.arc = new Arc(from, to)
  }

  get isOver(): boolean {
    return this.elapsed >= this.seconds
  }

  /**
   * Goes on; the position is one of the line, without the flight's height.
   *
   * @returns Height above the datum that the flight has there [m].
   */
  advance(deltaSeconds: number, position: Vector3, rotation: Quaternion): number {
    this.elapsed += deltaSeconds
    const time = this.seconds > 0 ? Math.min(this.elapsed / this.seconds, 1) : 1
    // Perlin's smootherstep: neither speed nor acceleration jumps.
    const part = time ** 3 * (time * (time * 6 - 15) + 10)
    const { from, to } = this
    if (part === 1 || this.arc === undefined) {
      position.lerpVectors(from.position, to.position, part)
      rotation.slerpQuaternions(from.rotation, to.rotation, part)
    } else this.arc.at(part, position, rotation)
    return from.height + (to.height - from.height) * part + this.rise * 4 * part * (1 - part)
  }
}
