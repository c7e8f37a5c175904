import { aerialPerspective, skyVelocity } from '@welkin/atmosphere'
import {
  cloudPreset,
  cloudQualities,
  clouds,
  cloudVelocity,
  type CloudQuality
} from '@welkin/clouds'
import { BoxGeometry, FloatType, Mesh, MeshBasicMaterial, PerspectiveCamera, Scene } from 'three'
import { traa } from 'three/addons/tsl/display/TRAANode.js'
import { convertToTexture, mrt, output, pass, velocity } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat, expectLight } from '../harness/atmosphere'
import { onGround } from '../harness/cloud-view'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { psnr, supersample } from '../harness/supersample'

/** Part of a picture of 960×540 pixels and 60°: clouds and pixels are as large as there. */
const size = { width: 48, height: 27 }
const FIELD = 3

/** Turn of a frame, about a pixel [rad]. */
const TURN = 0.0012
const TURNS = 12
/** Frames of which the supersampled picture is the mean, and those before. */
const SAMPLES = 16
const BEFORE = 8

/** Frames in which a still picture settles: in each, clouds march one pixel of a block. */
const settling = { medium: 128, high: 40 } as const

/** Clouds over boxes, under TRAA or not. */
class CloudyStage {
  readonly camera = new PerspectiveCamera(FIELD, size.width / size.height, 1, 1e5)
  readonly #pipeline: RenderPipeline
  readonly #owned: { dispose(): void }[]

  constructor(
    readonly renderer: WebGPURenderer,
    isTemporal: boolean,
    quality: CloudQuality
  ) {
    const { camera } = this
    const atmosphere = onGround()
    const scene = new Scene()
    for (let i = 0; i < 4; i++) {
      const box = new Mesh(new BoxGeometry(8, 500, 8), new MeshBasicMaterial())
      box.position.set(40 * i - 60, 300, -1000)
      box.rotation.z = 0.3
      box.material.color.setScalar(0.05 * (2 * i + 1))
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
    const drawn = isTemporal ? scenePass.getTextureNode('velocity') : depth
    // Without TRAA, too, clouds take the camera without jitter then: they are the same ones.
    const motion = cloudVelocity(skyVelocity(drawn, depth, camera), node)
    if (isTemporal) {
      scenePass.setMRT(mrt({ output, velocity }))
      const picture = convertToTexture(node)
      this.#pipeline.outputNode = traa(picture, depth, convertToTexture(motion), camera)
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
  supersample(): Promise<Picture> {
    return supersample(this.camera, size, SAMPLES, () => this.draw())
  }

  dispose(): void {
    for (const each of this.#owned) each.dispose()
  }
}

gpuTest(
  'under TRAA a still picture with clouds of usual qualities is as sharp as a supersampled one that marches every pixel, and a turning one has few trails',
  async t => {
    const renderer = await t.createRenderer(size)
    for (const name of ['medium', 'high'] as const) {
      const quality = cloudQualities[name]
      const exact = new CloudyStage(renderer, false, { ...quality, block: 1 })
      await exact.bake()
      const supersampled = async (angle: number): Promise<Picture> => {
        exact.turn(angle)
        for (let i = 0; i < BEFORE; i++) await exact.draw()
        return exact.supersample()
      }
      const still = await supersampled(0)
      expectLight(still, 'supersampled')
      const turned = name === 'high' ? await supersampled(TURN * TURNS) : null
      exact.dispose()

      const stage = new CloudyStage(renderer, true, quality)
      await stage.bake()
      stage.turn(0)
      let drawn = await stage.draw()
      for (let i = 1; i < settling[name]; i++) drawn = await stage.draw()
      const sharp = psnr(drawn, still)
      t.note(`${name}: still ${sharp.toFixed(1)} dB`)
      expectTrue(sharp >= 36, `${name}, still ${sharp} dB`)
      if (turned !== null) {
        for (let i = 1; i <= TURNS; i++) {
          stage.turn(TURN * i)
          drawn = await stage.draw()
        }
        expectLight(drawn, 'turning')
        const turning = psnr(drawn, turned)
        t.note(`${name}: turning ${turning.toFixed(1)} dB`)
        expectTrue(turning >= 27, `${name}, turning ${turning} dB`)
      }
      stage.dispose()
    }
  },
  { backends: ['webgpu'] }
)
