import { checkAtmosphere } from '../view/ViewNodes'
import { LightSource } from '../view/LightSource'
import { fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import type { Moon } from './Moon'
import { SunDirectionalLight } from '../lights/SunDirectionalLight'

/**
 * Moonlight: a directional light from the moon. Its phase and distance set its brightness; the air above
 * each fragment reddens it, the planet blocks it. The full moon gives about a quarter of a lux.
 *
 * Everything else is as with {@link SunDirectionalLight}, shadows included.
 */
export class MoonDirectionalLight extends SunDirectionalLight {
  /** Shared, not owned. */
  readonly moon: Moon

  /**
   * @param distance - Distance from the target to the light [world units].
   * @throws If `moon` is no {@link Moon}, or made for another atmosphere.
   */
  constructor(atmosphere: Atmosphere, moon: Moon, distance = 1) {
    checkAtmosphere('MoonDirectionalLight', atmosphere)
    if (!(moon?.source instanceof LightSource)) {
      fail('MoonDirectionalLight', 'moon must be a Moon', moon)
    }
    super(atmosphere, distance, moon.source)
    if (moon.atmosphere !== atmosphere) {
      fail('MoonDirectionalLight', 'moon must be made for the same atmosphere', moon)
    }
    this.moon = moon
  }

  override clone(): this {
    return new MoonDirectionalLight(this.atmosphere, this.moon, this.distance).copy(this) as this
  }
}
