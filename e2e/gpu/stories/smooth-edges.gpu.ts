import { DataTexture, DataUtils, HalfFloatType, LinearFilter } from 'three'
import { texture } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { smoothEdges } from '../../../stories/src/valley/SmoothEdgesNode'
import { drawToFloat } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const WIDTH = 192
const HEIGHT = 96

/** A star, a pixel large, and a streak of rain, a pixel wide. */
const THIN = [[30, 14], ...Array.from({ length: 9 }, (_, i) => [60, 5 + i])] as const

/** Light of land below a ridge, and of the sky. */
const lightAt = (x: number, y: number): number => {
  const ridge = HEIGHT / 2 + 14 * Math.sin(x / 23) + 5 * Math.sin(x / 7.3 + 1) + 0.07 * x
  return y > ridge ? 0.25 : 0.6
}

/** Light of a pixel, mean of so many samples along each side. */
function pixelLight(x: number, y: number, samples: number): number {
  let sum = 0
  for (let i = 0; i < samples ** 2; i++) {
    const [across, down] = [i % samples, Math.floor(i / samples)]
    sum += lightAt(x + (across + 0.5) / samples, y + (down + 0.5) / samples)
  }
  return sum / samples ** 2
}

gpuTest(
  'smooth edges bring a ridge nearer to a supersampled one, and leave a star and a streak of rain',
  async t => {
    const renderer = await t.createRenderer({ width: WIDTH, height: HEIGHT })
    const data = new Uint16Array(4 * WIDTH * HEIGHT)
    for (let y = 0; y < HEIGHT; y++) {
      for (let x = 0; x < WIDTH; x++) {
        const first = 4 * (y * WIDTH + x)
        data.fill(DataUtils.toHalfFloat(pixelLight(x, y, 1)), first, first + 4)
      }
    }
    for (const [x, y] of THIN) {
      const first = 4 * (y * WIDTH + x)
      data.fill(DataUtils.toHalfFloat(1), first, first + 4)
    }
    const picture = new DataTexture(data, WIDTH, HEIGHT, undefined, HalfFloatType)
    picture.minFilter = picture.magFilter = LinearFilter
    picture.flipY = false
    picture.needsUpdate = true
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = smoothEdges(texture(picture))
    const shown = await drawToFloat(renderer, () => pipeline.render())
    let [smooth, stairs] = [0, 0]
    for (let y = 20; y < HEIGHT; y++) {
      for (let x = 1; x < WIDTH - 1; x++) {
        const wanted = pixelLight(x, y, 8)
        smooth += (shown.at(x, y)[0] - wanted) ** 2
        stairs += (lightAt(x + 0.5, y + 0.5) - wanted) ** 2
      }
    }
    const left = Math.sqrt(smooth / stairs)
    t.note(`error over that of stairs ${left.toFixed(2)}`)
    expectTrue(left < 0.7, `error is ${left} of that of stairs`)
    for (const [x, y] of THIN) expectClose(shown.at(x, y)[0], 1, { absolute: 1e-3 }, `${x}, ${y}`)
    pipeline.dispose()
    picture.dispose()
  },
  { backends: ['webgpu'] }
)
