import { autoExposure, type Atmosphere, type AutoExposureNode } from '@welkin/atmosphere'
import type { CloudsNode } from '@welkin/clouds'
import type { PerspectiveCamera } from 'three'
import type { Node, WebGPURenderer } from 'three/webgpu'
import type { AirPost } from '../air'
import { frameClock } from '../scene'
import { PictureFinish, type PostEffects } from '../valley/finish'
import type { PictureNode } from '../valley/PictureNode'
import { withDepth } from '../valleyAir'

/** Post effects of a scene on a terrain, all off. */
export const NO_EFFECTS: PostEffects = {
  antialiasing: 'none',
  occlusion: false,
  localExposure: false,
  bloom: false,
  depthOfField: false,
  motionBlur: false
}

/** True if any post effect is on: these need a picture that is drawn to a texture. */
export const hasEffects = (effects: PostEffects): boolean =>
  Object.entries(NO_EFFECTS).some(([name, off]) => effects[name as keyof PostEffects] !== off)

/** Camera of a scene on a terrain: exposure by the picture, and post effects over it. */
export class GroundFinish {
  readonly #exposure: AutoExposureNode
  readonly #picture: PictureNode
  readonly #finish: PictureFinish
  readonly #elapsed: () => number

  /**
   * @param color - The picture with its air and clouds.
   * @param clouds - Clouds in it.
   * @param isStill - True for a scene of which one frame is shown.
   */
  constructor(
    renderer: WebGPURenderer,
    { scenePass, depth, pipeline }: AirPost,
    color: Node,
    camera: PerspectiveCamera,
    private readonly atmosphere: Atmosphere,
    clouds: CloudsNode | undefined,
    isStill: boolean
  ) {
    const picture = (this.#picture = withDepth(color, scenePass))
    const exposure = (this.#exposure = autoExposure(picture, atmosphere))
    const seen = { scenePass, depth, picture, exposure, clouds }
    this.#finish = new PictureFinish(renderer, pipeline, camera, seen)
    this.#elapsed = frameClock(isStill)
  }

  /**
   * Has the picture drawn with these effects; compiles if others were on.
   *
   * @param compensation - Brighter than metered [stops].
   */
  set(effects: PostEffects, compensation: number): void {
    this.#exposure.compensation = compensation
    this.#finish.set(effects)
  }

  /** Draws a frame. */
  draw(render: () => void): void {
    this.#exposure.adapt(this.#elapsed())
    const { luminanceScale } = this.atmosphere
    this.#finish.beforeDrawn(luminanceScale, 0)
    render()
    this.#finish.afterDrawn(luminanceScale)
  }

  /** Frees the effects. */
  dispose(): void {
    for (const owned of [this.#finish, this.#exposure, this.#picture]) owned.dispose()
  }
}
