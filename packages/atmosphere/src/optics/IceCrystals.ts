import { setOptions } from '@welkin/geo'
import { checkRange } from '../check'
import { crystalRows } from './cpu/crystalRows'
import { DOG_ELEVATIONS } from './cpu/sunDogs'
import { PhaseTexture } from './PhaseTexture'
import type { ScatteringAngles, ScatteringPhase } from './ScatteringPhase'
import { samplePhase } from './tsl/samplePhase'
import { sunDog } from './tsl/sunDog'
import type { Vec4 } from '../tsl-types'

/** Options of {@link IceCrystals}. */
export interface IceCrystalsOptions {
  /** Share of the crystals with flat faces, which make halos, in [0, 1], default 0.5; others are rough. */
  regular?: number
  /** Share of the plates that float level and make sun dogs, in [0, 1], default 0.3. */
  level?: number
}

const NAMES = ['regular', 'level'] as const

/**
 * Crystals of ice clouds: hexagonal columns and plates, half of each, with halos of 22° and 46°, and sun dogs where plates float level.
 *
 * ```ts
 * const light = new DropletLightTable({ crystals: iceCrystals({ level: 0.5 }) }) // of @welkin/clouds
 * ```
 *
 * Phase functions are by ray tracing, for crystals whose shadows are as large as discs of 20 to 80 µm in radius: they diffract light as those discs do, and the beams
 * that leave them spread, so that the edge of the halo is 1.3° wide. Colours are those of sunlight at 35 wavelengths over the sun's disc. Sun dogs stand at the sun's elevation while it is below 60°; what they have comes on top, at most 3 % of the light.
 */
export class IceCrystals implements ScatteringPhase {
  readonly #texture = new PhaseTexture('IceCrystals', 1 + DOG_ELEVATIONS.length)
  #regular = 0.5
  #level = 0.3
  #asymmetry = 0
  #version = 0

  /** @throws If an option is out of its range. */
  constructor(options: IceCrystalsOptions = {}) {
    this.set(options)
    if (this.#version === 0) this.#fill()
    this.#version = 0
  }

  /**
   * Changes settings.
   *
   * @throws If one is unknown or out of its range; then nothing has changed.
   */
  set(settings: IceCrystalsOptions): this {
    return setOptions('IceCrystals', this, settings, ...NAMES)
  }

  /** Share of the crystals with flat faces, in [0, 1]. */
  get regular(): number {
    return this.#regular
  }

  set regular(value: number) {
    checkRange('IceCrystals', 'regular', value, 0, 1)
    this.#regular = value
    this.#fill()
    this.#version++
  }

  /** Share of the plates that float level, in [0, 1]. */
  get level(): number {
    return this.#level
  }

  set level(value: number) {
    checkRange('IceCrystals', 'level', value, 0, 1)
    this.#level = value
    this.#fill()
    this.#version++
  }

  /** See {@link ScatteringPhase.asymmetry}; that of crystals with flat faces. */
  get asymmetry(): number {
    return this.#asymmetry
  }

  /** See {@link ScatteringPhase.version}. */
  get version(): number {
    return this.#version
  }

  #fill(): void {
    const { texels, asymmetry } = crystalRows(this.#regular, this.#level)
    this.#texture.write(texels)
    this.#asymmetry = asymmetry
  }

  phase(angles: ScatteringAngles): Vec4 {
    const { node } = this.#texture
    const allWays = samplePhase(node, angles.cosViewLight, 0.5 / (1 + DOG_ELEVATIONS.length))
    return allWays.add(sunDog(node, angles))
  }

  /** Frees its texture. */
  dispose(): void {
    this.#texture.texture.dispose()
  }
}

/** Crystals of ice clouds: see {@link IceCrystals}. */
export const iceCrystals = (options?: IceCrystalsOptions): IceCrystals => new IceCrystals(options)
