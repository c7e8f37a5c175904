import { varying } from 'three/tsl'
import { diffuseMoments } from '../diffuseLight/tsl/diffuseLight'
import type { Moments } from '../diffuseLight/tsl/moments'
import type { Air } from '../scattering/tsl/ray'
import type { Float, Vec4 } from '../tsl-types'
import { number } from '../uniforms'

/** Diffuse light in fog, the same for all of a picture: read at its vertices, as it changes little within a fog. */
export class FogMoments {
  readonly #altitude = number(0)
  /** Light at a cosine of its source, of which shaders have one each. */
  readonly #moments = new WeakMap<Float, Moments<Vec4>>()

  /** Altitude at which the light is read: the camera's, as far as that is in the fog [m]. */
  set altitude(value: number) {
    this.#altitude.value = value
  }

  /**
   * Moments of the diffuse light, for unit irradiance of its source, times `RADIANCE_SCALE`.
   *
   * @param cosLight - μ_s, of which a picture has one value.
   */
  of({ uniforms, diffuse }: Air, cosLight: Float): Moments<Vec4> {
    let moments = this.#moments.get(cosLight)
    if (moments === undefined) {
      const altitude = this.#altitude.clamp(0, uniforms.thickness) as Float
      const read = diffuseMoments(uniforms, diffuse!, altitude, cosLight)
      const varyings = Object.entries(read).map(([name, value]) => [name, varying(value)])
      moments = Object.fromEntries(varyings) as unknown as Moments<Vec4>
      this.#moments.set(cosLight, moments)
    }
    return moments
  }
}
