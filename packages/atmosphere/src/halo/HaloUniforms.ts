import { renderGroup, uniform } from 'three/tsl'
import { checkNonNegative, checkOptions, checkPositive } from '@welkin/geo'

/** Halo that an eye or a lens makes around a bright source, in two lobes. */
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

const scalar = (value: number) => uniform(value).setGroup(renderGroup)

/** Lobes of a halo as shader uniforms, which may be changed at any time. */
export class HaloUniforms {
  readonly innerPower = scalar(0)
  readonly innerStrength = scalar(0)
  readonly outerPower = scalar(0)
  readonly outerStrength = scalar(0)
  /** Cosine of the angle from the source at which the halo ends; above 1 for no halo. */
  readonly cosMaxAngle = scalar(2)

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

  /** @param isVisible - The source is above the horizon and shines. */
  update(isVisible: boolean): void {
    // Square of the angle at which a lobe falls to MIN_RADIANCE.
    const square = (power: number, strength: number): number =>
      (2 / power) * Math.log(((power + 1) * strength) / (2 * Math.PI * MIN_RADIANCE))
    const widest = Math.max(
      square(this.innerPower.value, this.innerStrength.value),
      square(this.outerPower.value, this.outerStrength.value)
    )
    this.cosMaxAngle.value = isVisible && widest > 0 ? 1 - Math.min(widest, 4) / 2 : 2
  }
}
