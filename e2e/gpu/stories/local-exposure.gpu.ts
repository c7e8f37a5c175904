import { DataTexture, FloatType } from 'three'
import { texture } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { LocalExposure } from '../../../stories/src/valley/LocalExposure'
import { drawToFloat } from '../harness/atmosphere'
import { expectClose } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'

const WIDTH = 192
const HEIGHT = 108

/** log2 of luminance of land, at the left, and of the sky; and the half range of stripes in both. */
const LAND = -5
const SKY = 0
const STRIPES = 0.25

gpuTest(
  'local exposure raises dark land, lowers bright sky less, keeps what is in them, and has no halo',
  async t => {
    const size = { width: WIDTH, height: HEIGHT }
    const renderer = await t.createRenderer(size)
    const logs = Array.from({ length: WIDTH * HEIGHT }, (_, i) => {
      const x = i % WIDTH
      return (x < WIDTH / 2 ? LAND : SKY) + (x % 8 < 4 ? STRIPES : -STRIPES)
    })
    const data = new Float32Array(logs.flatMap(log => [2 ** log, 2 ** log, 2 ** log, 1]))
    const picture = new DataTexture(data, WIDTH, HEIGHT, undefined, FloatType)
    picture.needsUpdate = true
    const local = new LocalExposure(renderer, texture(picture))
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = local.shown(texture(picture))
    /** log2 of luminance along the middle of the picture. */
    const draw = async (): Promise<number[]> => {
      await nextFrame()
      const shown = await drawToFloat(renderer, () => pipeline.render())
      return Array.from({ length: WIDTH }, (_, x) => Math.log2(shown.at(x, HEIGHT / 2)[1]))
    }
    const mean = (from: number, values: number[]): number =>
      values.slice(from, from + 8).reduce((sum, value) => sum + value, 0) / 8
    const before = await draw()
    expectClose(mean(16, before), LAND, { absolute: 0.01 }, 'the first picture is as it is')
    local.update(renderer, 1)
    const after = await draw()
    const [land, sky] = [mean(16, after), mean(168, after)]
    t.note(`land ${land.toFixed(2)}, sky ${sky.toFixed(2)}`)
    expectClose(land - LAND, 0.73, { absolute: 0.1 }, 'stops of land')
    expectClose(sky - SKY, -0.38, { absolute: 0.1 }, 'stops of the sky')
    // Beside the edge as far from it, and stripes as they were.
    expectClose(mean(88, after), land, { absolute: 0.06 }, 'land beside the sky')
    expectClose(mean(96, after), sky, { absolute: 0.06 }, 'sky beside the land')
    for (const at of [16, 168]) {
      const contrast = after[at + 1] - after[at + 5]
      expectClose(contrast, 2 * STRIPES, { relative: 0.2 }, 'stripes')
    }
    local.strength = 0
    expectClose(mean(16, await draw()), LAND, { absolute: 0.01 }, 'nothing by night')
    local.dispose()
    pipeline.dispose()
    picture.dispose()
  }
)
