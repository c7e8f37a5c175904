import { expectLight } from '../harness/atmosphere'
import { CloudyStage, type Temporal } from '../harness/cloudy-stage'
import { expectTrue } from '../harness/expect'
import type { GpuContext } from '../harness/context'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'
import { trailOf } from '../harness/trails'

const size = { width: 64, height: 36 }
/** Frames at rest, frames in which the camera pans, and turn of each [rad]: a pixel. */
const REST = 16
const PAN = 10
const TURN = 0.018
/** Frames back to the picture of which a trail is looked for. */
const BACK = 3
/** Frames in which the exact picture settles. */
const SETTLING = 6
/** Most of an earlier picture that may be left. */
const MOST = 0.05

/** Pictures as they should be at the end of the pan, and frames before and after. */
async function exactPictures(
  t: GpuContext
): Promise<[now: Picture, earlier: Picture, later: Picture]> {
  const stage = new CloudyStage(await t.createRenderer(size), 'none')
  await stage.bake()
  const at = async (frame: number): Promise<Picture> => {
    stage.turn(TURN * frame)
    for (let i = 0; i < SETTLING; i++) await stage.draw()
    return stage.supersample(size)
  }
  const pictures: [Picture, Picture, Picture] = [
    await at(PAN),
    await at(PAN - BACK),
    await at(PAN + BACK)
  ]
  expectLight(pictures[0], 'exact')
  stage.dispose()
  return pictures
}

/** Picture at the end of a pan. */
async function panned(t: GpuContext, temporal: Temporal): Promise<Picture> {
  const stage = new CloudyStage(await t.createRenderer(size), temporal)
  await stage.bake()
  let drawn: Picture | undefined
  for (let frame = -REST; frame <= PAN; frame++) {
    stage.turn(TURN * Math.max(frame, 0))
    drawn = await stage.draw()
  }
  stage.dispose()
  return drawn!
}

gpuTest(
  'clouds leave no trails under TRAA and TAAU while the camera pans',
  async t => {
    const exact = await exactPictures(t)
    const trail = async (temporal: Temporal): Promise<number> =>
      trailOf(await panned(t, temporal), ...exact)
    const [sharp, upscaled] = [await trail('traa'), await trail('taau')]
    const percent = (value: number): string => `${(100 * value).toFixed(1)} %`
    t.note(`left of ${BACK} frames before: TRAA ${percent(sharp)}, TAAU ${percent(upscaled)}`)
    // With three's velocities alone, in which sky and clouds stand still, TRAA leaves 35 %.
    expectTrue(Math.abs(sharp) < MOST, `${percent(sharp)} are left under TRAA`)
    expectTrue(Math.abs(upscaled) < MOST, `${percent(upscaled)} are left under TAAU`)
  },
  { backends: ['webgpu'] }
)
