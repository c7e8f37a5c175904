import { renderGroup, uniform } from 'three/tsl'
import { checkNonNegative, checkOptions, checkPositive } from '@welkin/geo'

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

const scalar = (value: number) => uniform(value).setGroup(renderGroup)

/** A halo's figures as shader uniforms; they may be changed at any time. */
export class HaloUniforms {
  readonly innerPower = scalar(0)
  readonly innerStrength = scalar(0)
  readonly outerPower = scalar(0)
  readonly outerStrength = scalar(0)
  /** Cosine of the angle from its middle where a halo ends; above 1 for none. */
  readonly cosReach = scalar(2)

  /** @param owner - Names the class in errors. */
  constructor(
    private readonly owner: string,
    options: Required<FlareOptions>
  ) {
    this.set(options)
  }

  /** @throws If a figure is unknown or out of its range; then nothing has changed. */
  set(options: FlareOptions): void {
    const entries = Object.entries(checkOptions(this.owner, options, ...NAMES)) as [
      keyof FlareOptions,
      number | undefined
    ][]
    for (const [name, value] of entries) {
      const check = name.endsWith('Power') ? checkPositive : checkNonNegative
      if (value !== undefined) check(this.owner, name, value)
    }
    for (const [name, value] of entries) if (value !== undefined) this[name].value = value
  }

  /** @param isSeen - Whether there is light to spread. */
  update(isSeen: boolean): void {
    const square = (power: number, strength: number): number =>
      (2 / power) * Math.log(((power + 1) * strength) / (2 * Math.PI * FAINTEST))
    const widest = Math.max(
      square(this.innerPower.value, this.innerStrength.value),
      square(this.outerPower.value, this.outerStrength.value)
    )
    this.cosReach.value = isSeen && widest > 0 ? 1 - Math.min(widest, 4) / 2 : 2
  }
}
