import { Droplets } from '@welkin/atmosphere'
import type { ScatteringPhase } from '@welkin/atmosphere'
import { checkOptions, fail } from '@welkin/geo'
import { mix, smoothstep, vec4 } from 'three/tsl'
import type { CloudLight, FineSampleNodes, LightScatterers } from './CloudLightTable'
import type { CloudLobes } from './cpu/cloudPhase'
import { dropletLobes } from './cpu/dropletLobes'
import { fineStructure } from './tsl/fineStructure'
import type { Vec4 } from '../tsl-types'

/** Options of {@link CloudParticles}. */
export interface CloudParticlesOptions {
  /** Effective radius of the droplets, in [3, 30], default 10 [µm]: larger ones make smaller glories and narrower bows. */
  dropletRadius?: number
  /** Crystals of high clouds, `iceCrystals()`, with halo and sun dogs; shared, not owned. Default: null. */
  crystals?: ScatteringPhase | null
}

/** Altitudes between which droplets turn to ice, at −15 °C and −38 °C of the standard atmosphere [m]. */
const ICE_FROM = 4600
const ICE_TO = 8150

/**
 * Particles of clouds: droplets of a size, by Mie's theory, with corona, cloudbow and glory; and crystals above 4.6 to 8.2 km.
 *
 * ```ts
 * const light = new CloudLightTable({ particles: cloudParticles({ dropletRadius: 8 }) })
 * pipeline.outputNode = clouds(air, depth, camera, atmosphere, layers, { light })
 * light.particles.dropletRadius = 15 // at any time
 * ```
 *
 * Light scattered once has the exact phase function; light scattered more often has lobes of its moments. Clouds of droplets let more
 * light through than the lobes of fair weather do, which are less peaked: g is 0.86 in place of 0.6.
 */
export class CloudParticles implements LightScatterers {
  readonly crystals: ScatteringPhase | null
  readonly #droplets: Droplets

  /** @throws If an option is out of its range. */
  constructor(options: CloudParticlesOptions = {}) {
    checkOptions('CloudParticles', options, 'dropletRadius', 'crystals')
    const { dropletRadius = 10, crystals = null } = options
    if (crystals !== null && typeof crystals.phase !== 'function') {
      fail('CloudParticles', 'crystals must be iceCrystals() or null', crystals)
    }
    this.crystals = crystals
    this.#droplets = new Droplets({ radius: dropletRadius }, ['CloudParticles', 'dropletRadius'])
  }

  /** Effective radius of the droplets, in [3, 30] [µm]. */
  get dropletRadius(): number {
    return this.#droplets.radius
  }

  set dropletRadius(radius: number) {
    this.#droplets.radius = radius
  }

  get version(): number {
    return this.#droplets.version
  }

  /** Lobes of the droplets' moments. */
  get lobes(): CloudLobes {
    return dropletLobes(this.#droplets.moments)
  }

  fineStructure(light: CloudLight, sample: FineSampleNodes): Vec4 {
    const water = fineStructure(light, this.#droplets, sample)
    const ice = this.crystals === null ? vec4(0) : fineStructure(light, this.crystals, sample)
    return mix(water, ice, smoothstep(ICE_FROM, ICE_TO, sample.altitude))
  }

  /** Frees its texture; the crystals stay. */
  dispose(): void {
    this.#droplets.dispose()
  }
}

/** Particles of clouds: see {@link CloudParticles}. */
export const cloudParticles = (options?: CloudParticlesOptions): CloudParticles =>
  new CloudParticles(options)
