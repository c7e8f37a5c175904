import { checkAtmosphere } from '../view/ViewNodes'
import { fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { Moon } from './Moon'
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
   * @throws If `moon` is no {@link Moon}, or another atmosphere's.
   */
  constructor(atmosphere: Atmosphere, moon: Moon, distance = 1) {
    checkAtmosphere('MoonDirectionalLight', atmosphere)
    if (!(moon instanceof Moon)) fail('MoonDirectionalLight', 'moon must be a Moon', moon)
    super(atmosphere, distance, moon.attach(atmosphere).source)
    this.moon = moon
  }

  override clone(): this {
    return new MoonDirectionalLight(this.atmosphere, this.moon, this.distance).copy(this) as this
  }
}
