import { float, uv, vec4 } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { pack, unpack } from '../../../packages/clouds/src/temporal/tsl/packing'
import type { Float, Vec4 } from '../../../packages/clouds/src/tsl-types'
import { drawToFloat } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const SIZE = { width: 256, height: 32 }

/** Ranges of log₂ distances and of sample counts: see `pack`. */
const FIRST_OCTAVE = 4
const LAST_OCTAVE = 28
const MOST_SAMPLES = 256

/** Place of a pixel along a side of the picture, in [0, 1]. */
const along = (i: number, size: number): number => i / (size - 1)

gpuTest('history in four bytes has its distances and counts as exactly as they say', async t => {
  const renderer = await t.createRenderer(SIZE)
  const { x, y } = uv() as unknown as { x: Float; y: Float }
  const part = (place: Float, size: number): Float =>
    place
      .mul(size)
      .floor()
      .div(size - 1)
  const [across, down] = [part(x, SIZE.width), part(y, SIZE.height)]
  const octaves = across.mul(LAST_OCTAVE - FIRST_OCTAVE).add(FIRST_OCTAVE)
  const samples = across.sub(0.5).mul(2 * MOST_SAMPLES)
  const bytes = pack(octaves, octaves, samples.mul(down.mul(down)), float(0.5))
  // As a target of bytes keeps them.
  const kept = bytes.mul(255).round().div(255) as Vec4
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputColorTransform = false
  pipeline.outputNode = vec4(unpack(kept).xyz, down)
  const { data } = await drawToFloat(renderer, () => pipeline.render())
  /** Greatest errors of the clouds' distance and of the end [octaves], of counts up to 16 and of others. */
  const worst = [0, 0, 0, 0]
  for (let i = 0; i < data.length; i += 4) {
    const [distance, end, count, row] = data.subarray(i, i + 4)
    const column = along((i / 4) % SIZE.width, SIZE.width)
    const wanted = column * (LAST_OCTAVE - FIRST_OCTAVE) + FIRST_OCTAVE
    const wantedCount = (column - 0.5) * 2 * MOST_SAMPLES * row ** 2
    const range = Math.abs(wantedCount) <= 16 ? 2 : 3
    worst[0] = Math.max(worst[0], Math.abs(distance - wanted))
    worst[1] = Math.max(worst[1], Math.abs(end - wanted))
    worst[range] = Math.max(worst[range], Math.abs(count - wantedCount))
  }
  t.note(
    `distance ${worst[0].toFixed(4)}, end ${worst[1].toFixed(3)} octaves, counts ${worst[2].toFixed(4)}, ${worst[3].toFixed(3)}`
  )
  expectTrue(worst[0] <= 0.006, `distances are off by ${worst[0]} octaves`)
  expectTrue(worst[1] <= 0.0475, `ends are off by ${worst[1]} octaves`)
  expectTrue(worst[2] <= 0.0041, `small counts are off by ${worst[2]}`)
  expectTrue(worst[3] <= 0.063, `great counts are off by ${worst[3]}`)
  pipeline.dispose()
})
