import { aerialPerspective, heightFog, skyVelocity } from '@welkin/atmosphere'
import { FloatType } from 'three'
import { traa } from 'three/addons/tsl/display/TRAANode.js'
import { convertToTexture, mrt, output, pass, velocity } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { addBox, stage } from '../harness/shaft-stage'
import { psnr, supersample } from '../harness/supersample'

const size = { width: 96, height: 54 }
/** Frames in which TRAA converges, and frames of which the supersampled picture is the mean. */
const [FRAMES, SAMPLES] = [24, 16]
/** Elevation of the sun [°], and way that the tower goes in a frame [m]. */
const [SUN, STEP] = [8, 150]

/** A tower in mist before the sun, under TRAA or not. */
function towerInMist(renderer: WebGPURenderer, isTemporal: boolean) {
  const set = stage(renderer, SUN)
  const { atmosphere, camera, scene, shafts } = set
  atmosphere.luminanceScale = 3
  atmosphere.add(heightFog({ density: 4e-4, falloff: 300 }))
  addBox(scene, [0, -10, 0], [8000, 20, 8000])
  const tower = addBox(scene, [0, 150, -900], [120, 300, 60])
  camera.position.y = 60
  camera.rotation.x = 0.06
  const scenePass = pass(scene, camera, { samples: 0, type: FloatType })
  const depth = scenePass.getTextureNode('depth')
  const air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere, { shafts })
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputColorTransform = false
  pipeline.outputNode = air
  if (isTemporal) {
    scenePass.setMRT(mrt({ output, velocity }))
    const motion = skyVelocity(scenePass.getTextureNode('velocity'), depth, camera)
    pipeline.outputNode = traa(convertToTexture(air), depth, convertToTexture(motion), camera)
  }
  const draw = async (): Promise<Picture> => {
    camera.updateMatrixWorld()
    await nextFrame()
    return drawToFloat(renderer, () => pipeline.render())
  }
  return {
    camera,
    shafts,
    draw,
    async settle() {
      for (let i = 1; i < FRAMES; i++) await draw()
      return draw()
    },
    moveTower: () => {
      tower.position.x += STEP
    },
    dispose() {
      for (const owned of [scenePass, pipeline, set]) owned.dispose()
    }
  }
}

gpuTest(
  'under TRAA has shafts as sharp as in a supersampled picture, which go with their caster in the same frame',
  async t => {
    const renderer = await t.createRenderer(size)
    const exact = towerInMist(renderer, false)
    await exact.draw()
    const before = await supersample(exact.camera, size, SAMPLES, exact.draw)
    exact.moveTower()
    const after = await supersample(exact.camera, size, SAMPLES, exact.draw)
    exact.dispose()
    const temporal = towerInMist(renderer, true)
    const sharp = psnr(await temporal.settle(), before)
    temporal.moveTower()
    const [moved, unmoved] = [psnr(await temporal.draw(), after), psnr(before, after)]
    const settled = psnr(await temporal.settle(), after)
    temporal.dispose()
    t.note(
      `still ${sharp.toFixed(1)} dB, in the frame in which the tower moves ${moved.toFixed(1)} dB, ` +
        `by a picture that had not changed ${unmoved.toFixed(1)} dB, settled ${settled.toFixed(1)} dB`
    )
    expectTrue(sharp >= 36, `still ${sharp} dB`)
    expectTrue(settled >= 36, `settled ${settled} dB`)
    expectTrue(moved >= 30 && moved >= unmoved + 6, `moved ${moved} dB, ${unmoved}`)
  },
  // TRAA is three's, and shafts have no history.
  { backends: ['webgpu'] }
)
