import { Vector3 } from 'three'
import { matrix3, number, vector3, vector4 } from '../uniforms'
import type { Float, Vec3, Vec4 } from '../tsl-types'
import { drawnSizes, type DrawnClass } from './cpu/drawnParticles'
import { numberBetween } from './cpu/sizes'
import type { FallingLattice } from './FallingLattice'
import type { ParticleKind } from './ParticleKind'

const _middle = new Vector3()
const _drift = new Vector3()

/** A class of size as uniforms have it. */
export interface ClassNodes {
  /** Its number. */
  readonly index: Float
  /** Side of its box, and distance up to which it is drawn [m]. */
  readonly side: Float
  readonly reach: Float
  /** Particles of its box of the sizes that they are drawn from. */
  readonly proposed: Float
  /** Least diameter [mm], and 1 − e^{−ΛΔD} over the class. */
  readonly edge: Float
  readonly range: Float
  readonly weight: Float
  readonly fullReach: Float
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
  /** Velocity of the air relative to the camera [m/s], without fall. */
  readonly velocity = vector3()
  readonly #sizes = [0, 1, 2, 3].map(() => vector4())
  readonly #boxes = [0, 1, 2, 3].map(() => vector4())
  readonly #drifts = [0, 1, 2, 3].map(() => vector4())
  readonly #middles = [0, 1, 2, 3].map(() => vector4())

  constructor(private readonly kind: ParticleKind) {}

  /**
   * Sets the rate.
   *
   * @param rate - Rate as water [mm/h].
   * @param classes - Classes as they are drawn at it.
   */
  setRate(rate: number, classes: readonly DrawnClass[]): void {
    const { kind } = this
    const { drawn, there } = drawnSizes(kind, rate)
    this.share.value = there.intercept / drawn.intercept
    this.slope.value = drawn.slope - there.slope
    classes.forEach(({ side, proposed, weight }, i) => {
      const [from, to] = [kind.edges[i], kind.edges[i + 1]]
      const range = numberBetween(drawn, from, to) / numberBetween(drawn, from, Infinity)
      this.#sizes[i].value.set(from, range, weight, kind.fullReach[i])
      this.#boxes[i].value.set(side, kind.reach[i], proposed, i)
    })
  }

  /** Sets uniforms for a camera. */
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

  /** Values of a class. @param index - Its number. */
  classOf(index: Float): ClassNodes {
    const isPast = (i: number) => index.greaterThan(i - 0.5)
    const pick = (values: readonly unknown[]): Vec4 => {
      const [a, b, c, d] = values as Vec4[]
      const far = isPast(3).select(d, c)
      return isPast(2).select(far, isPast(1).select(b, a)).toConst()
    }
    const sizes = pick(this.#sizes)
    const box = pick(this.#boxes)
    return {
      index,
      side: box.x,
      reach: box.y,
      proposed: box.z,
      edge: sizes.x,
      range: sizes.y,
      weight: sizes.z,
      fullReach: sizes.w,
      middle: pick(this.#middles).xyz,
      drift: pick(this.#drifts).xyz
    }
  }
}
