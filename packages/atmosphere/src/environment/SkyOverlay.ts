import type { Renderer } from 'three/webgpu'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { Vec3 } from '../tsl-types'
import type { ViewNodes } from '../view/ViewNodes'

/** Something in front of the sky of a {@link SkyEnvironmentNode}: clouds. */
export interface SkyOverlay {
  /** Changes when what it shows has changed by so much that it has to be drawn again. */
  readonly version: number
  /** Frames that it takes to be drawn, before the faces of the sky. */
  readonly steps: number
  /**
   * Takes a step of its drawing; the view's nodes are up to date.
   *
   * @param view - View whose camera stands where the environment is seen from.
   * @param step - Index of the step, from 0 to `steps` − 1.
   */
  draw(renderer: Renderer, view: AtmosphereView, step: number): void
  /**
   * Lays it over the sky. Called when the shader is built.
   *
   * @param direction - In the mapped space, unit length.
   * @param sky - Linear sRGB × `luminanceScale`.
   * @returns Colour with the overlay before it.
   */
  over(view: ViewNodes, direction: Vec3, sky: Vec3): Vec3
}
