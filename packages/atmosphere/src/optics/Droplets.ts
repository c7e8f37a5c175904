import { setOptions } from '@welkin/geo'
import { checkRange } from '../check'
import { diffractedRow } from './cpu/diffractedRow'
import { DROPLET_RADII } from './cpu/dropletRadii'
import { dropletRow } from './cpu/dropletRow'
import { PhaseTexture } from './PhaseTexture'
import type { ScatteringAngles, ScatteringPhase } from './ScatteringPhase'
import { samplePhase } from './tsl/samplePhase'
import type { Vec4 } from '../tsl-types'

/** Options of {@link Droplets}. */
export interface DropletsOptions {
  /** Effective radius, in [3, 30], default 10 [µm]: fog and young clouds have 3 to 8, cumulus and decks 8 to 15, drizzle more. */
  radius?: number
}

/**
 * Droplets of clouds and fog: how they scatter sunlight, by Mie's theory, with corona, fogbow and glory.
 *
 * ```ts
 * atmosphere.add(heightFog({ base: 280, falloff: 60, droplets: droplets({ radius: 8 }) }))
 * ```
 *
 * Sizes follow a gamma distribution of effective variance 0.04 (Hansen & Travis 1974); colours are those of sunlight at 35 wavelengths,
 * over the sun's disc. Larger droplets: a narrower, brighter bow, a smaller glory and corona. One object may serve many media.
 *
 * @see Bohren & Huffman 1983, "Absorption and scattering of light by small particles", chapter 4
 */
export class Droplets implements ScatteringPhase {
  readonly #texture = new PhaseTexture('Droplets', 2)
  #radius = 10
  #moments: readonly [number, number, number] = [0, 0, 0]
  #version = 0

  readonly #radiusName: readonly [string, string]

  /**
   * @param radiusName - Names class and parameter in errors.
   * @throws If the radius is out of its range.
   */
  constructor(
    options: DropletsOptions = {},
    radiusName: readonly [string, string] = ['Droplets', 'radius']
  ) {
    this.#radiusName = radiusName
    this.set(options)
    if (this.#version === 0) this.#fill()
    this.#version = 0
  }

  /**
   * Changes settings.
   *
   * @throws If one is unknown or out of its range; then nothing has changed.
   */
  set(settings: DropletsOptions): this {
    return setOptions('Droplets', this, settings, 'radius')
  }

  /** Effective radius, in [3, 30] [µm]. */
  get radius(): number {
    return this.#radius
  }

  set radius(value: number) {
    checkRange(...this.#radiusName, value, DROPLET_RADII[0], DROPLET_RADII.at(-1)!)
    this.#radius = value
    this.#fill()
    this.#version++
  }

  /** See {@link ScatteringPhase.asymmetry}. */
  get asymmetry(): number {
    return this.#moments[0]
  }

  /** Legendre coefficients χ₁, χ₂ and χ₃ of the phase function. */
  get moments(): readonly [number, number, number] {
    return this.#moments
  }

  /** See {@link ScatteringPhase.version}. */
  get version(): number {
    return this.#version
  }

  #fill(): void {
    const { texels, moments } = dropletRow(this.#radius)
    this.#texture.write([...texels, ...diffractedRow(texels, this.#radius)])
    this.#moments = moments
  }

  phase({ cosViewLight }: ScatteringAngles): Vec4 {
    return samplePhase(this.#texture.node, cosViewLight, 0.25)
  }

  diffracted({ cosViewLight }: ScatteringAngles): Vec4 {
    return samplePhase(this.#texture.node, cosViewLight, 0.75)
  }

  /** Frees its texture. */
  dispose(): void {
    this.#texture.texture.dispose()
  }
}

/** Droplets of clouds and fog: see {@link Droplets}. */
export const droplets = (options?: DropletsOptions): Droplets => new Droplets(options)
