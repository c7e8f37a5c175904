import { Quaternion, Vector3, type PerspectiveCamera } from 'three'
import type { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { RADIUS } from './groundMaterial'

/** Distance by which receivers of shadows are moved along their normals [texels]. */
const NORMAL_BIAS = 1.2

/** Frames at the start in which all cascades are drawn: stills have few. */
const WHOLE_FRAMES = 10

/** Turn of the camera by which all cascades are drawn at once [rad]: they are wider than what it sees, on each side, by 0.11 of their distance at least. */
const TURN = 0.08

/** Way of the camera [parts of a cascade's width], and turn of the sun [rad], after which a cascade is drawn anew. */
const WAY = 0.01
const SUN_TURN = 3e-3

/** Radius of the sun [rad]. */
const SUN_RADIUS = 4.7e-3

/** Sine of the sun's elevation below which all up to an altitude lies in the shadow of the Earth [m]. */
const sunkBelow = (altitude: number): number =>
  -Math.sin(Math.sqrt((2 * Math.max(altitude, 0)) / RADIUS) + SUN_RADIUS)

/** A cascade as it was drawn. */
interface Drawn {
  readonly camera: Vector3
  readonly sun: Vector3
  /** Frame in which it was. */
  frame: number
}

/**
 * Has cascades of shadows drawn by turns, and only where camera or sun have moved: what stands still costs nothing, nor does what the
 * sun has left.
 */
export class CascadeTurns {
  readonly #cascades: CSMShadowNode
  readonly #drawn: Drawn[] = []
  /** Attitude of the camera for which all were drawn last. */
  readonly #attitude = new Quaternion()
  #frame = 0
  #isWhole = true

  constructor(cascades: CSMShadowNode) {
    this.#cascades = cascades
  }

  /** Has all cascades drawn with the next frame: other things cast shadows now. */
  reset(): void {
    this.#isWhole = true
  }

  /**
   * Chooses the cascades that the next frame draws.
   *
   * @param sun - Direction to the sun, world, unit length.
   * @param altitude - Altitude of the camera [m].
   */
  update(camera: PerspectiveCamera, sun: Vector3, altitude: number): void {
    const frame = this.#frame++
    const isTurned = camera.quaternion.angleTo(this.#attitude) > TURN
    const isWhole = this.#isWhole || frame < WHOLE_FRAMES || isTurned
    if (isWhole) this.#attitude.copy(camera.quaternion)
    this.#isWhole = false
    const stale: number[] = []
    for (const [i, { shadow }] of this.#cascades.lights.entries()) {
      if (shadow === undefined) continue
      const { left, right } = shadow.camera
      shadow.normalBias = (NORMAL_BIAS * (right - left)) / shadow.mapSize.x
      shadow.autoUpdate = false
      const drawn = (this.#drawn[i] ??= { camera: new Vector3(), sun: new Vector3(), frame: -1 })
      const isMoved = drawn.camera.distanceTo(camera.position) > WAY * (right - left)
      if (isMoved || drawn.sun.distanceTo(sun) > SUN_TURN) stale.push(i)
    }
    const oldest = stale.toSorted((a, b) => this.#drawn[a].frame - this.#drawn[b].frame).slice(0, 1)
    for (const i of isWhole ? this.#drawn.keys() : oldest) {
      const { shadow } = this.#cascades.lights[i]
      const { left, right } = shadow!.camera
      if (sun.y < sunkBelow(altitude + (right - left) / 2) && frame >= WHOLE_FRAMES) {
        // Drawn once the sun is back.
        this.#drawn[i].sun.set(0, 0, 0)
        this.#drawn[i].frame = frame
        continue
      }
      shadow!.needsUpdate = true
      this.#drawn[i].camera.copy(camera.position)
      this.#drawn[i].sun.copy(sun)
      this.#drawn[i].frame = frame
    }
  }
}
