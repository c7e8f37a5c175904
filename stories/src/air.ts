import { aerialPerspective } from '@welkin/atmosphere'
import type { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import type { Camera, Scene } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import type { WebGPURenderer } from 'three/webgpu'
import { quickStart } from './quickStart'

/** How the air is drawn: by the materials themselves, or over the finished picture. */
export type AirPath = 'forward' | 'post'

/** The quick start's sky, haze, sunlight and sky light for a scene, by either path. */
export class Air {
  readonly atmosphere: Atmosphere
  readonly sun: SunDirectionalLight
  private readonly sky: SkyLightProbe
  private readonly pipeline: RenderPipeline | undefined

  constructor(
    private readonly renderer: WebGPURenderer,
    private readonly scene: Scene,
    private readonly camera: Camera,
    path: AirPath
  ) {
    const { atmosphere, sun, sky } = quickStart(scene)
    this.atmosphere = atmosphere
    this.sun = sun
    this.sky = sky
    if (path === 'post') {
      scene.backgroundNode = null
      scene.fogNode = null
      // One sample: the air needs the depth of the very point that the colour is of.
      const scenePass = pass(scene, camera, { samples: 0 })
      const color = scenePass.getTextureNode()
      const depth = scenePass.getTextureNode('depth')
      this.pipeline = new RenderPipeline(renderer)
      this.pipeline.outputNode = aerialPerspective(color, depth, camera, atmosphere)
    }
  }

  render(): void {
    if (this.pipeline === undefined) {
      this.renderer.render(this.scene, this.camera)
    } else {
      this.pipeline.render()
    }
  }

  dispose(): void {
    this.scene.remove(this.sun, this.sun.target, this.sky)
    this.sun.dispose()
    this.sky.dispose()
    this.pipeline?.dispose()
    this.atmosphere.dispose()
  }
}
