import { renderGroup, uniform } from 'three/tsl'
import { checkNonNegative, checkPositive, setOptions } from '@welkin/geo'

/** Light that an eye or a lens spreads around something bright, in two lobes. */
export interface FlareOptions {
  /** Power of the tight inner lobe, cosⁿ of the angle: the larger, the tighter; > 0. */
  innerPower?: number
  /** Part of the light that the inner lobe gets, ≥ 0. */
  innerStrength?: number
  /** Power of the broad outer lobe, > 0. */
  outerPower?: number
  /** Part of the light that the outer lobe gets, ≥ 0. */
  outerStrength?: number
}

/** Radiance at which a lobe ends, for unit irradiance by what is in its middle [1/sr]. */
const FAINTEST = 1e-8

const NAMES = ['innerPower', 'innerStrength', 'outerPower', 'outerStrength'] as const

const scalar = () => uniform(0).setGroup(renderGroup)

/** A halo's figures: checked properties, kept in shader uniforms. They may be changed at any time. */
export class Flare {
  declare innerPower: number
  declare innerStrength: number
  declare outerPower: number
  declare outerStrength: number
  /** What shaders read. */
  readonly uniforms = {
    innerPower: scalar(),
    innerStrength: scalar(),
    outerPower: scalar(),
    outerStrength: scalar(),
    /** Cosine of the angle from its middle where a halo ends; above 1 for none. */
    cosReach: uniform(2).setGroup(renderGroup)
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

  /** @param isSeen - Whether there is light to spread. */
  setReach(isSeen: boolean): void {
    const square = (power: number, strength: number): number =>
      (2 / power) * Math.log(((power + 1) * strength) / (2 * Math.PI * FAINTEST))
    const widest = Math.max(
      square(this.innerPower, this.innerStrength),
      square(this.outerPower, this.outerStrength)
    )
    this.uniforms.cosReach.value = isSeen && widest > 0 ? 1 - Math.min(widest, 4) / 2 : 2
  }
}
