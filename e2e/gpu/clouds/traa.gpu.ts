import { aerialPerspective, skyVelocity } from '@welkin/atmosphere'
import { cloudPreset, cloudQualities, clouds, cloudVelocity } from '@welkin/clouds'
import type { CloudQuality } from '@welkin/clouds'
import { BoxGeometry, FloatType, Mesh, MeshBasicMaterial, PerspectiveCamera, Scene } from 'three'
import { traa } from 'three/addons/tsl/display/TRAANode.js'
import { convertToTexture, mrt, output, pass, velocity } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat, expectLight } from '../harness/atmosphere'
import { coarse, onGround } from '../harness/cloud-view'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { psnr, supersample } from '../harness/supersample'

const size = { width: 96, height: 54 }
/** Frames in which TRAA converges, and turn of a frame [rad]. */
const FRAMES = 40
const TURN = 0.012
const TURNS = 12
/** Frames in which the exact picture settles, and of which it is then the mean. */
const SETTLING = 12
const SAMPLES = 16
/** Part of a picture of 960×540 pixels and 60°, in which clouds are as large as there; frames in which they settle, and those of the exact picture. */
const part = { width: 48, height: 27, field: 3, frames: 128, exactFrames: 24 } as const

/** Clouds over boxes, under TRAA or not. */
class CloudyStage {
  readonly camera: PerspectiveCamera
  readonly #pipeline: RenderPipeline
  readonly #owned: { dispose(): void }[]

  constructor(
    readonly renderer: WebGPURenderer,
    isTemporal: boolean,
    quality: CloudQuality = { ...coarse, block: 1 },
    field = 60
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
  supersample(drawn: { width: number; height: number } = size): Promise<Picture> {
    return supersample(this.camera, drawn, SAMPLES, () => this.draw())
  }

  dispose(): void {
    for (const each of this.#owned) each.dispose()
  }
}

gpuTest(
  'under TRAA a still picture with clouds is as sharp as a supersampled one, and a turning one has few trails',
  async t => {
    const renderer = await t.createRenderer(size)
    const exact = new CloudyStage(renderer, false)
    await exact.bake()
    const supersampled = async (angle: number): Promise<Picture> => {
      exact.turn(angle)
      for (let i = 0; i < SETTLING; i++) await exact.draw()
      return exact.supersample()
    }
    const still = await supersampled(0)
    expectLight(still, 'supersampled')
    const turned = await supersampled(TURN * TURNS)
    exact.dispose()

    const stage = new CloudyStage(renderer, true)
    await stage.bake()
    stage.turn(0)
    let drawn = await stage.draw()
    for (let i = 1; i < FRAMES; i++) drawn = await stage.draw()
    const sharp = psnr(drawn, still)
    for (let i = 1; i <= TURNS; i++) {
      stage.turn(TURN * i)
      drawn = await stage.draw()
    }
    expectLight(drawn, 'turning')
    const turning = psnr(drawn, turned)
    stage.dispose()
    t.note(`still ${sharp.toFixed(1)} dB, turning ${turning.toFixed(1)} dB`)
    expectTrue(sharp >= 36, `still ${sharp} dB`)
    // With three's velocities alone, in which sky and clouds stand still, there are 3 dB less.
    expectTrue(turning >= 27, `turning ${turning} dB`)
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'at the default quality a still picture under TRAA is as sharp as a supersampled one that marches every pixel',
  async t => {
    const renderer = await t.createRenderer(part)
    const { high } = cloudQualities
    const exact = new CloudyStage(renderer, false, { ...high, block: 1 }, part.field)
    await exact.bake()
    exact.turn(0)
    for (let i = SAMPLES; i < part.exactFrames; i++) await exact.draw()
    const still = await exact.supersample(part)
    expectLight(still, 'supersampled')
    exact.dispose()
    const stage = new CloudyStage(renderer, true, high, part.field)
    await stage.bake()
    stage.turn(0)
    let drawn = await stage.draw()
    for (let i = 1; i < part.frames; i++) drawn = await stage.draw()
    const sharp = psnr(drawn, still)
    stage.dispose()
    t.note(`still ${sharp.toFixed(1)} dB`)
    expectTrue(sharp >= 36, `still ${sharp} dB`)
  },
  { backends: ['webgpu'] }
)
