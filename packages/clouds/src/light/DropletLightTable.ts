import { Droplets } from '@welkin/atmosphere'
import type { ScatteringPhase } from '@welkin/atmosphere'
import { checkOptions, fail } from '@welkin/geo'
import { mix, smoothstep, vec4 } from 'three/tsl'
import { CloudLightTable, type CloudLight, type FineSampleNodes } from './CloudLightTable'
import type { CloudPhaseParameters } from './cpu/cloudPhase'
import { dropletLobes } from './cpu/dropletLobes'
import { fineStructure } from './tsl/fineStructure'
import type { Vec4 } from '../tsl-types'

/** Options of {@link DropletLightTable}. */
export interface DropletLightOptions {
  /** Effective radius of the droplets, in [3, 30], default 10 [µm]: larger ones make smaller glories and narrower bows. */
  dropletRadius?: number
  /** Crystals of clouds above 4.6 to 8.2 km, with halos; shared, not owned. Default: null. */
  crystals?: ScatteringPhase | null
  /** Share of the extinguished light that is scattered, in [0, 0.99999], default 0.99999. */
  scatteringAlbedo?: number
}

/** Altitudes between which droplets turn to ice, at −15 °C and −38 °C of the standard atmosphere [m]. */
const ICE_FROM = 4600
const ICE_TO = 8150

/**
 * Light of clouds made of droplets of a size, by Mie's theory: with corona, cloudbow and glory.
 *
 * ```ts
 * const light = new DropletLightTable({ dropletRadius: 8 })
 * pipeline.outputNode = clouds(air, depth, camera, atmosphere, layers, { light })
 * light.dropletRadius = 15 // at any time
 * ```
 *
 * Light scattered once has their phase function; light scattered more often has lobes of its moments, which follow from the radius and
 * cannot be set. Clouds of droplets let more light through than those of a `CloudLightTable` do by default, whose lobes are less peaked: an
 * asymmetry of 0.86 in place of 0.6.
 */
export class DropletLightTable extends CloudLightTable {
  /** Crystals of high clouds; shared, not owned. */
  readonly crystals: ScatteringPhase | null
  readonly #droplets: Droplets

  /** @throws If an option is unknown or out of its range. */
  constructor(options: DropletLightOptions = {}) {
    checkOptions('DropletLightTable', options, 'dropletRadius', 'crystals', 'scatteringAlbedo')
    const { dropletRadius, crystals = null, scatteringAlbedo } = options
    if (crystals !== null && typeof crystals.phase !== 'function') {
      fail('DropletLightTable', 'crystals must be a ScatteringPhase or null', crystals)
    }
    const name = ['DropletLightTable', 'dropletRadius'] as const
    const droplets = new Droplets({ radius: dropletRadius }, name)
    super({ ...dropletLobes(droplets.moments), scatteringAlbedo })
    this.crystals = crystals
    this.#droplets = droplets
    this.nodes.fineStructure = sample => this.#fineStructure(this.nodes, sample)
  }

  /** Effective radius of the droplets, in [3, 30] [µm]. */
  get dropletRadius(): number {
    return this.#droplets.radius
  }

  set dropletRadius(radius: number) {
    this.#droplets.radius = radius
    super.set(dropletLobes(this.#droplets.moments))
  }

  /**
   * Changes settings.
   *
   * @throws If one is unknown or out of its range, or a lobe, which the droplets decide; then nothing has changed.
   */
  override set(changes: Partial<CloudPhaseParameters> & { dropletRadius?: number }): this {
    // The parent's constructor sets the first lobes.
    if (!(#droplets in this)) return super.set(changes)
    checkOptions('DropletLightTable', changes, 'dropletRadius', 'scatteringAlbedo')
    const { dropletRadius = this.dropletRadius, scatteringAlbedo } = changes
    super.set({ scatteringAlbedo })
    this.dropletRadius = dropletRadius
    return this
  }

  #fineStructure(light: CloudLight, sample: FineSampleNodes): Vec4 {
    const water = fineStructure(light, this.#droplets, sample)
    const ice = this.crystals === null ? vec4(0) : fineStructure(light, this.crystals, sample)
    return mix(water, ice, smoothstep(ICE_FROM, ICE_TO, sample.altitude))
  }

  /** Frees table and droplets; the crystals stay. */
  override dispose(): void {
    this.#droplets.dispose()
    super.dispose()
  }
}
