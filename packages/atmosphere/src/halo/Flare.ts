import { checkNonNegative, checkPositive, setOptions } from '@welkin/geo'
import { number } from '../uniforms'

/**
 * Halo that an eye or a lens makes around a bright source, in two lobes. Defaults, in this order: 6000, 0.006, 150 and 0.004 for the sun,
 * 12,000, 0.02, 500 and 0.006 for the moon.
 */
export interface FlareOptions {
  /** Power n of the tight inner lobe, cosⁿ of the angle: larger is tighter; > 0. */
  innerPower?: number
  /** Fraction of the source's light in the inner lobe, ≥ 0. */
  innerStrength?: number
  /** Power of the broad outer lobe, > 0. */
  outerPower?: number
  /** Fraction of the source's light in the outer lobe, ≥ 0. */
  outerStrength?: number
}

/** Radiance at which a lobe is cut off, for unit irradiance by its source [1/sr]. */
const MIN_RADIANCE = 1e-8

const NAMES = ['innerPower', 'innerStrength', 'outerPower', 'outerStrength'] as const

/** Lobes of a halo: checked properties, kept in shader uniforms. They may be changed at any time. */
export class Flare {
  declare innerPower: number
  declare innerStrength: number
  declare outerPower: number
  declare outerStrength: number
  /** Strengths as shaders read them. */
  readonly uniforms = {
    innerPower: number(),
    innerStrength: number(),
    outerPower: number(),
    outerStrength: number(),
    /** Cosine of the angle from the source at which the halo ends; above 1 for no halo. */
    cosMaxAngle: number(2)
  }
  readonly #owner: string

  static {
    for (const name of NAMES) {
      const check = name.endsWith('Power') ? checkPositive : checkNonNegative
      Object.defineProperty(Flare.prototype, name, {
        get(this: Flare) {
          return this.uniforms[name].value
        },
        set(this: Flare, value: number) {
          check(this.#owner, name, value)
          this.uniforms[name].value = value
        }
      })
    }
  }

  /** @param owner - Names the class in errors. */
  constructor(owner: string, options: Required<FlareOptions>) {
    this.#owner = owner
    this.set(options)
  }

  /**
   * Changes some figures.
   *
   * @throws If one is unknown or out of its range; then nothing has changed.
   */
  set(options: FlareOptions): this {
    return setOptions(this.#owner, this, options, ...NAMES)
  }

  /** @param isVisible - The source is above the horizon and shines. */
  updateMaximumAngle(isVisible: boolean): void {
    // Square of the angle at which a lobe falls to MIN_RADIANCE.
    const square = (power: number, strength: number): number =>
      (2 / power) * Math.log(((power + 1) * strength) / (2 * Math.PI * MIN_RADIANCE))
    const widest = Math.max(
      square(this.innerPower, this.innerStrength),
      square(this.outerPower, this.outerStrength)
    )
    this.uniforms.cosMaxAngle.value = isVisible && widest > 0 ? 1 - Math.min(widest, 4) / 2 : 2
  }
}
