import type { PerspectiveCamera, Vector3 } from 'three'
import type { Explorer } from '../moving/Explorer'
import { descend, DESCENT_SECONDS } from './descentPath'

/** The way from the map to the ground in one take, until it ends or whoever watches takes over. */
export class Descent {
  #part = 0
  #runs = true

  /**
   * @param center - The Earth's centre [km].
   * @param radius - The Earth's radius [km].
   * @param explorer - Its keys, pointer, wheel and views end the descent; left out, nothing does.
   */
  constructor(
    private readonly center: Vector3,
    private readonly radius: number,
    private readonly explorer?: Explorer
  ) {}

  /** Part of the way that is done, in [0, 1]. */
  get part(): number {
    return this.#part
  }

  /** False once the camera is on the ground, or the explorer's. */
  get runs(): boolean {
    return this.#runs
  }

  /** Goes on from a part of the way, in [0, 1]. */
  start(part: number): void {
    this.#part = part
    this.#runs = true
    this.explorer?.takeUse() // what was pressed before is no wish to end it
  }

  /** Puts the camera on the way, and goes on. Called once per frame. */
  update(camera: PerspectiveCamera, seconds: number): void {
    const isTaken = this.explorer?.takeUse() ?? false
    if (isTaken) this.#runs = false
    if (!this.#runs) return
    this.#part = Math.min(this.#part + seconds / DESCENT_SECONDS, 1)
    descend(camera, this.#part, this.center, this.radius)
    if (this.#part === 1 && this.explorer !== undefined) this.#runs = false
  }
}
