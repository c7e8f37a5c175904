import { Vector3 } from 'three'
import { int } from 'three/tsl'
import { matrix3, number, vector3, vector4 } from '../uniforms'
import type { Float, Int, Vec3, Vec4 } from '../tsl-types'
import { drawnParticles, drawnSizes } from './cpu/drawnParticles'
import { numberBetween } from './cpu/sizes'
import type { FallingLattice } from './FallingLattice'
import type { ParticleKind } from './ParticleKind'

/** Particles that a chunk of the mesh has. */
export const CHUNK = 256

const _middle = new Vector3()
const _drift = new Vector3()

/** A class of size as uniforms have it. */
export interface ClassNodes {
  /** Its number. */
  readonly index: Float
  /** First of its particles' chunks. */
  readonly firstChunk: Float
  /** Side of its box, and distance up to which it is drawn [m]. */
  readonly side: Float
  readonly reach: Float
  /** Particles of its box of the sizes that they are drawn from. */
  readonly proposed: Float
  /** Least diameter [mm], and 1 − e^{−ΛΔD} over the class. */
  readonly edge: Float
  readonly range: Float
  readonly weight: Float
  /** Middle of its box from the camera [m], and drift over its side. */
  readonly middle: Vec3
  readonly drift: Vec3
}

/** Uniforms of falling particles. */
export class PrecipitationUniforms {
  /** Share of the drawn sizes that are there at the rate, at diameter 0, and how it changes [1/mm]. */
  readonly share = number()
  readonly slope = number()
  readonly phase = number()
  /** Shutter [s], aperture [m], distance in focus [m]. */
  readonly shutter = number()
  readonly aperture = number()
  readonly focus = number()
  readonly opacity = number(1)
  readonly unit = number(1)
  /** Displacements in the lattice's frame [m] to view space [world units]. */
  readonly toView = matrix3()
  /** Velocity of air against the camera [m/s], without fall. */
  readonly velocity = vector3()
  readonly #sizes = [0, 1, 2, 3].map(() => vector4())
  readonly #boxes = [0, 1, 2, 3].map(() => vector4())
  readonly #drifts = [0, 1, 2, 3].map(() => vector4())
  readonly #middles = [0, 1, 2, 3].map(() => vector4())

  constructor(private readonly kind: ParticleKind) {}

  /**
   * Takes a rate.
   *
   * @param rate - [mm/h].
   * @param most - Most particles of a class.
   * @returns Chunks to draw.
   */
  setRate(rate: number, most: number): number {
    const { kind } = this
    const { drawn, there } = drawnSizes(kind, rate)
    this.share.value = there.intercept / drawn.intercept
    this.slope.value = drawn.slope - there.slope
    let chunk = 0
    drawnParticles(kind, rate, most).forEach(({ side, proposed, count, weight }, i) => {
      const [from, to] = [kind.edges[i], kind.edges[i + 1]]
      const range = numberBetween(drawn, from, to) / numberBetween(drawn, from, Infinity)
      this.#sizes[i].value.set(from, range, weight, chunk)
      this.#boxes[i].value.set(side, kind.reach[i], proposed, i)
      chunk += Math.ceil(count / CHUNK)
    })
    return chunk
  }

  /** Takes the frame of a camera. */
  setView(lattice: FallingLattice): void {
    const { toView, unit, phase, wind, cameraVelocity } = lattice
    this.toView.value.setFromMatrix4(toView)
    this.unit.value = unit
    this.phase.value = phase
    this.velocity.value.copy(wind).sub(cameraVelocity)
    this.kind.reach.forEach((reach, i) => {
      lattice.box(reach, _middle, _drift)
      this.#middles[i].value.set(..._middle.toArray(), 0)
      this.#drifts[i].value.set(..._drift.toArray(), 0)
    })
  }

  /** Class of a chunk, as nodes. */
  classOf(chunk: Int): ClassNodes {
    const at = int(chunk).toFloat().toConst() as unknown as Float
    const isPast = (i: number) => at.greaterThanEqual(this.#sizes[i].w)
    const pick = (values: readonly unknown[]): Vec4 => {
      const [a, b, c, d] = values as Vec4[]
      const far = isPast(3).select(d, c)
      return isPast(2).select(far, isPast(1).select(b, a)).toConst()
    }
    const sizes = pick(this.#sizes)
    const box = pick(this.#boxes)
    return {
      index: box.w,
      firstChunk: sizes.w,
      side: box.x,
      reach: box.y,
      proposed: box.z,
      edge: sizes.x,
      range: sizes.y,
      weight: sizes.z,
      middle: pick(this.#middles).xyz,
      drift: pick(this.#drifts).xyz
    }
  }
}
