import type { Camera } from 'three'
import type { Atmosphere } from '../Atmosphere'
import { adaptedScale } from './cpu/exposedScale'
import { exposureFor, type ExposureOptions } from './exposureFor'

/** Last `luminanceScale` written to an atmosphere, and its value for exposure 1. */
const scales = new WeakMap<Atmosphere, { written: number; daylight: number }>()

/**
 * Exposure that adapts to the light over time, as eyes do: writes an atmosphere's `luminanceScale`.
 *
 * It multiplies the scale that it finds, unless another adaptation wrote that: from that it takes over.
 */
export class ExposureAdaptation {
  readonly #atmosphere: Atmosphere
  /** `luminanceScale` for exposure 1 [1/(cd/m²)]. */
  readonly daylightScale: number
  #exposure: number | null = null

  constructor(atmosphere: Atmosphere) {
    this.#atmosphere = atmosphere
    const { luminanceScale } = atmosphere
    const previous = scales.get(atmosphere)
    this.daylightScale = previous?.written === luminanceScale ? previous.daylight : luminanceScale
  }

  /** Exposure now: 1 in full daylight. */
  get exposure(): number {
    return this.#exposure ?? 1
  }

  /**
   * Moves the exposure towards that for a camera.
   *
   * @param seconds - Time since the last update [s].
   * @param timeConstant - Time to adapt by 63 %; 0 adapts at once [s].
   */
  update(camera: Camera, options: ExposureOptions, seconds: number, timeConstant: number): void {
    const target = exposureFor(this.#atmosphere, camera, options)
    const last = this.#exposure ?? target
    this.#exposure = adaptedScale(last, target, Math.abs(seconds), timeConstant)
    const written = this.daylightScale * this.#exposure
    this.#atmosphere.luminanceScale = written
    scales.set(this.#atmosphere, { written, daylight: this.daylightScale })
  }
}
