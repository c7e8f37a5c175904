import {
  aerialPerspective,
  aerialPerspectiveFog,
  autoExposure,
  skyBackground,
  SkyLightProbe,
  SunDirectionalLight
} from '@welkin/atmosphere'
import type { Atmosphere, AutoExposureNode } from '@welkin/atmosphere'
import type { Camera, Scene } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import type { Node, PassNode, TextureNode, WebGPURenderer } from 'three/webgpu'
import { quickStart } from './quickStart'
import type { QuickStart } from './quickStart'

/** Path by which the air is drawn: in the materials themselves, or over the finished picture. */
export type AirPath = 'forward' | 'post'

/** The quick start for an existing atmosphere. */
function airOf(scene: Scene, atmosphere: Atmosphere): QuickStart {
  const sun = new SunDirectionalLight(atmosphere)
  const sky = new SkyLightProbe(atmosphere)
  scene.add(sun, sun.target, sky)
  scene.backgroundNode = skyBackground(atmosphere)
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  return { atmosphere, sun, sky }
}

/** The post path's picture: what a further effect, such as clouds, takes and where it goes. */
export interface AirPost {
  readonly scenePass: PassNode
  /** The scene without its air. */
  readonly picture: Node
  /** The scene with its air. */
  readonly color: Node
  /** The scene's depth. */
  readonly depth: TextureNode
  readonly pipeline: RenderPipeline
}

/** The quick start's sky, haze, sunlight and sky light for a scene, by either path. */
export class Air {
  readonly atmosphere: Atmosphere
  readonly sun: SunDirectionalLight
  readonly sky: SkyLightProbe
  /** Undefined on the forward path. */
  readonly post: AirPost | undefined
  #pipeline: RenderPipeline | undefined

  constructor(
    private readonly renderer: WebGPURenderer,
    private readonly scene: Scene,
    private readonly camera: Camera,
    path: AirPath,
    given?: Atmosphere
  ) {
    const { atmosphere, sun, sky } = given === undefined ? quickStart(scene) : airOf(scene, given)
    this.atmosphere = atmosphere
    this.sun = sun
    this.sky = sky
    if (path === 'post') {
      // #region post effect
      scene.backgroundNode = scene.fogNode = null // the post effect draws sky and haze
      const scenePass = pass(scene, camera, { samples: 0 }) // one: colour and depth of the same point
      const depth = scenePass.getTextureNode('depth')
      const color = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere)
      const pipeline = new RenderPipeline(renderer)
      pipeline.outputNode = color
      // #endregion
      this.post = { scenePass, picture: scenePass.getTextureNode(), color, depth, pipeline }
      this.#pipeline = pipeline
    }
  }

  /**
   * Has the picture set the exposure, on either path.
   *
   * @param color - The picture; left out, the scene with its air.
   */
  expose(color: Node = this.post?.color ?? pass(this.scene, this.camera)): AutoExposureNode {
    const pipeline = (this.#pipeline ??= new RenderPipeline(this.renderer))
    const exposure = autoExposure(color, this.atmosphere)
    pipeline.outputNode = exposure
    return exposure
  }

  render(): void {
    if (this.#pipeline === undefined) this.renderer.render(this.scene, this.camera)
    else this.#pipeline.render()
  }

  dispose(): void {
    this.scene.remove(this.sun, this.sun.target, this.sky)
    this.sun.dispose()
    this.sky.dispose()
    this.#pipeline?.dispose()
    this.atmosphere.dispose()
  }
}
