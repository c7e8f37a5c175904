import {
  aerialPerspective,
  aerialPerspectiveFog,
  skyBackground,
  SkyLightProbe,
  SunDirectionalLight
} from '@welkin/atmosphere'
import type { Atmosphere } from '@welkin/atmosphere'
import type { Camera, Scene } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import type { WebGPURenderer } from 'three/webgpu'
import { quickStart } from './quickStart'
import type { QuickStart } from './quickStart'

/** How the air is drawn: by the materials themselves, or over the finished picture. */
export type AirPath = 'forward' | 'post'

/** What the quick start does, with an atmosphere that is there. */
function airOf(scene: Scene, atmosphere: Atmosphere): QuickStart {
  const sun = new SunDirectionalLight(atmosphere)
  const sky = new SkyLightProbe(atmosphere)
  scene.add(sun, sun.target, sky)
  scene.backgroundNode = skyBackground(atmosphere)
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  return { atmosphere, sun, sky }
}

/** The quick start's sky, haze, sunlight and sky light for a scene, by either path. */
export class Air {
  readonly atmosphere: Atmosphere
  readonly sun: SunDirectionalLight
  readonly sky: SkyLightProbe
  private readonly pipeline: RenderPipeline | undefined

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
