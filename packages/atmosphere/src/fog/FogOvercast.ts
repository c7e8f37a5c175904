import type { Renderer } from 'three/webgpu'
import type { Float, Vec4 } from '../tsl-types'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { LightSource } from '../view/LightSource'

/** Clouds' part in the light of a fog: what `cloudFogLight` of `@welkin/clouds` gives, or one's own. */
export interface FogOvercast {
  /**
   * Draws what shaders read. Called before a render.
   *
   * @param altitude - Altitude of the fog [m].
   */
  prepare(renderer: Renderer, view: AtmosphereView, altitude: number): void
  /** Sets uniforms for the camera that renders. */
  update(view: AtmosphereView): void
  /**
   * Light in the fog over that under a clear sky: of the light that fog scatters once, which arrives unscattered, in [0, 1]; and of all
   * other light, at the four wavelengths [–]. Read in branches: no derivatives.
   *
   * @param cosLight - μ_s of the source.
   */
  light(source: LightSource, cosLight: Float): { direct: Float; diffuse: Vec4 }
}
