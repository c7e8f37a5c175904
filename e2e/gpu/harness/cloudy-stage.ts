import { aerialPerspective, skyVelocity } from '@welkin/atmosphere'
import { cloudPreset, clouds, cloudVelocity } from '@welkin/clouds'
import type { CloudQuality } from '@welkin/clouds'
import { BoxGeometry, FloatType, Mesh, MeshBasicMaterial, PerspectiveCamera, Scene } from 'three'
import { taau } from 'three/addons/tsl/display/TAAUNode.js'
import { traa } from 'three/addons/tsl/display/TRAANode.js'
import { convertToTexture, mrt, output, pass, rtt, velocity } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from './atmosphere'
import { coarse, onGround } from './cloud-view'
import { nextFrame } from './graphics'
import type { Picture } from './picture'
import { supersample } from './supersample'

/** Frames of which a picture is the mean that is taken for exact. */
export const SAMPLES = 16

/** Pixels along a side that TAAU has drawn, over those that it shows. */
const SMALL = 0.5

/** Anti-aliasing over frames, if there is any. */
export type Temporal = 'none' | 'traa' | 'taau'

/** Settings of a {@link CloudyStage}. */
export interface CloudyOptions {
  readonly quality?: CloudQuality
  /** Vertical field of view [°]. */
  readonly field?: number
}

/** Clouds over boxes, under TRAA or TAAU or not. */
export class CloudyStage {
  readonly camera: PerspectiveCamera
  readonly #pipeline: RenderPipeline
  readonly #owned: { dispose(): void }[]

  constructor(
    readonly renderer: WebGPURenderer,
    temporal: Temporal,
    { quality = { ...coarse, block: 1 }, field = 60 }: CloudyOptions = {}
  ) {
    const camera = (this.camera = new PerspectiveCamera(field, 16 / 9, 1, 1e5))
    const atmosphere = onGround()
    const scene = new Scene()
    for (let i = 0; i < 8; i++) {
      const box = new Mesh(new BoxGeometry(60, 150 + 40 * i, 60), new MeshBasicMaterial())
      box.position.set(1000 * Math.sin(i), 0, -1000 * Math.cos(i))
      box.material.color.setScalar(0.05 * (i + 1))
      scene.add(box)
    }
    camera.position.set(0, 300, 0)
    const scenePass = pass(scene, camera, { samples: 0, type: FloatType })
    const depth = scenePass.getTextureNode('depth')
    const air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere)
    const node = clouds(air, depth, camera, atmosphere, cloudPreset('fairWeather'), {
      quality,
      time: 0
    })
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputColorTransform = false
    this.#pipeline.outputNode = node
    const drawn = temporal === 'none' ? depth : scenePass.getTextureNode('velocity')
    // Without TRAA, too, clouds take the camera without jitter then: they are the same ones.
    const motion = cloudVelocity(skyVelocity(drawn, depth, camera), node)
    if (temporal !== 'none') scenePass.setMRT(mrt({ output, velocity }))
    if (temporal === 'traa') {
      const [picture, moves] = [convertToTexture(node), convertToTexture(motion)]
      this.#pipeline.outputNode = traa(picture, depth, moves, camera)
    }
    if (temporal === 'taau') {
      scenePass.setResolutionScale(SMALL)
      const small = { resolutionScale: SMALL }
      const [picture, moves] = [rtt(node, null, null, small), rtt(motion, null, null, small)]
      this.#pipeline.outputNode = taau(picture, depth, moves, camera)
    }
    this.#owned = [node, atmosphere, scenePass, this.#pipeline]
    this.bake = () => node.bake(renderer)
  }

  readonly bake: () => Promise<void>

  turn(angle: number): void {
    this.camera.rotation.set(0.25, angle, 0, 'YXZ')
    this.camera.updateMatrixWorld()
  }

  async draw(): Promise<Picture> {
    await nextFrame()
    return drawToFloat(this.renderer, () => this.#pipeline.render())
  }

  /** Mean of frames with offsets within a pixel. */
  supersample(drawn: { width: number; height: number }): Promise<Picture> {
    return supersample(this.camera, drawn, SAMPLES, () => this.draw())
  }

  dispose(): void {
    for (const each of this.#owned) each.dispose()
  }
}
