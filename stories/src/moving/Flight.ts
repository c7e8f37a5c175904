import type { Quaternion, Vector3 } from 'three'

/** Height that a flight gains on its way, over the distance. */
const RISE = 0.1

export interface FlightEnd {
  readonly position: Vector3
  readonly rotation: Quaternion
  /** Height above the datum [m]. */
  readonly height: number
}

/** A smooth flight between two views. */
export class Flight {
  /** Settles the promise of whoever asked for the flight. */
  readonly end: () => void
  private readonly from: FlightEnd
  private readonly to: FlightEnd
  private readonly seconds: number
  private readonly rise: number
  private elapsed = 0

  /** @param seconds - Time that it takes, ≥ 0 [s]. */
  constructor(from: FlightEnd, to: FlightEnd, seconds: number, end: () => void) {
    this.from = from
    this.to = to
    this.seconds = seconds
    this.end = end
    this.rise = RISE * from.position.distanceTo(to.position)
  }

  get isOver(): boolean {
    return this.elapsed >= this.seconds
  }

  /**
   * Goes on; the position is one of the straight line.
   *
   * @returns Height above the datum that the flight has there [m].
   */
  advance(deltaSeconds: number, position: Vector3, rotation: Quaternion): number {
    this.elapsed += deltaSeconds
    const time = this.seconds > 0 ? Math.min(this.elapsed / this.seconds, 1) : 1
    // Perlin's smootherstep: neither speed nor acceleration jumps.
    const part = time ** 3 * (time * (time * 6 - 15) + 10)
    const { from, to } = this
    position.lerpVectors(from.position, to.position, part)
    rotation.slerpQuaternions(from.rotation, to.rotation, part)
    return from.height + (to.height - from.height) * part + this.rise * 4 * part * (1 - part)
  }
}
