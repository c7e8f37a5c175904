import { Vector3 } from 'three'
import { Atmosphere, type AtmosphereOptions } from './Atmosphere'
import { SphericalSpace } from './cpu/spherical'

const _above = new Vector3()

/** A space in which every position lies above the world's origin. */
class FlatSpace extends SphericalSpace {
  override position(world: Vector3, target: Vector3): Vector3 {
    return super.position(_above.set(0, world.y, 0), target)
  }
}

/**
 * The sky of a flat world: up is +Y wherever the camera goes, and height is y. For scenes with no
 * planet, however far they reach.
 *
 * ```ts
 * const atmosphere = flatAtmosphere()
 * scene.backgroundNode = skyBackground(atmosphere)
 * ```
 *
 * It looks just like an {@link Atmosphere} of the same parameters does at its origin, the horizon's dip
 * and the reddening of a low sun included. What the camera sees is hazed and lit as if the ground fell
 * away from it with the planet's curve: over 10 km by 8 m and 0.1° of the sun's height.
 */
export class FlatAtmosphere extends Atmosphere {
  readonly #space = new FlatSpace()

  override get space(): SphericalSpace {
    this.#space.set(this.worldToECEF, this.ellipsoid, this.parameters.bottomRadius)
    return this.#space
  }
}

/** The sky of a flat world: see {@link FlatAtmosphere}. */
export const flatAtmosphere = (options: AtmosphereOptions = {}): FlatAtmosphere =>
  new FlatAtmosphere(options)
