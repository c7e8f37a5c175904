import { setOptions } from '@welkin/geo'
import { checkRange } from '../check'
import { rainRow } from './cpu/rainRow'
import { PhaseTexture } from './PhaseTexture'
import type { ScatteringAngles, ScatteringPhase } from './ScatteringPhase'
import { samplePhase } from './tsl/samplePhase'
import type { Vec4 } from '../tsl-types'

/** Options of {@link Raindrops}. */
export interface RaindropsOptions {
  /** Rate of the rain, in [0, 300], default 5 [mm/h]: drizzle has 0.5, a shower 10, a cloudburst 50. */
  rate?: number
}

const DEFAULT_RATE = 5

/**
 * Drops of rain: how they scatter sunlight, by Mie's theory, with both rainbows and the dark band between them.
 *
 * ```ts
 * const rain = raindrops({ rate: 8 })
 * atmosphere.add(heightFog({ density: rain.extinction, falloff: 250, droplets: rain })) // all about
 * ```
 *
 * Sizes are those of Marshall and Palmer (1948), from 0.1 to 3.5 mm; drops are taken to be round. Colours are those of sunlight at 35
 * wavelengths, over the sun's disc.
 *
 * @see Bohren & Huffman 1983, "Absorption and scattering of light by small particles", chapter 4
 */
export class Raindrops implements ScatteringPhase {
  readonly #texture = new PhaseTexture('Raindrops', 1)
  #rate = 0
  #asymmetry = 0
  #version = 0

  /** @throws If the rate is out of its range. */
  constructor(options: RaindropsOptions = {}) {
    this.rate = DEFAULT_RATE
    this.set(options)
    this.#version = 0
  }

  /**
   * Changes settings.
   *
   * @throws If one is unknown or out of its range; then nothing has changed.
   */
  set(settings: RaindropsOptions): this {
    return setOptions('Raindrops', this, settings, 'rate')
  }

  /** Rate of the rain, in [0, 300] [mm/h]. Light is scattered as by rates from 0.5 to 50, below and above as at those. */
  get rate(): number {
    return this.#rate
  }

  set rate(value: number) {
    checkRange('Raindrops', 'rate', value, 0, 300)
    this.#rate = value
    const { texels, moments } = rainRow(value)
    this.#texture.write(texels)
    this.#asymmetry = moments[0]
    this.#version++
  }

  /**
   * Extinction of rain of this rate [1/m].
   *
   * 0.33 R^0.64 per km, as Atlas (1953) measured it.
   */
  get extinction(): number {
    return (0.33 * this.#rate ** 0.64) / 1000
  }

  /** See {@link ScatteringPhase.asymmetry}. */
  get asymmetry(): number {
    return this.#asymmetry
  }

  /** See {@link ScatteringPhase.version}. */
  get version(): number {
    return this.#version
  }

  phase({ cosViewLight }: ScatteringAngles): Vec4 {
    return samplePhase(this.#texture.node, cosViewLight, 0.5)
  }

  /** Frees its texture. */
  dispose(): void {
    this.#texture.texture.dispose()
  }
}

/** Drops of rain: see {@link Raindrops}. */
export const raindrops = (options?: RaindropsOptions): Raindrops => new Raindrops(options)
