import { expectLight } from '../harness/atmosphere'
import { CloudyStage, type CloudyOptions, type Temporal } from '../harness/cloudy-stage'
import { expectTrue } from '../harness/expect'
import type { GpuContext } from '../harness/context'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'
import { trailOf } from '../harness/trails'

const size = { width: 96, height: 54 }
/** Frames at rest, frames in which the camera pans, and turn of each [rad]: a pixel. */
const REST = 16
const PAN = 10
const TURN = 0.012
/** Frames back to the picture of which a trail is looked for. */
const BACK = 3
/** Frames in which the exact picture settles. */
const SETTLING = 8
/** Most of an earlier picture that may be left. */
const MOST = 0.1

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
async function panned(
  t: GpuContext,
  temporal: Temporal,
  options?: CloudyOptions
): Promise<Picture> {
  const stage = new CloudyStage(await t.createRenderer(size), temporal, options)
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
  'clouds leave no trails under TRAA and TAAU while the camera pans, which three has with its own velocities',
  async t => {
    const exact = await exactPictures(t)
    const trail = async (temporal: Temporal, options?: CloudyOptions): Promise<number> =>
      trailOf(await panned(t, temporal, options), ...exact)
    const none = await trail('none')
    const [sharp, upscaled] = [await trail('traa'), await trail('taau')]
    const still = await trail('traa', { cloudsMove: false })
    const percent = (value: number): string => `${(100 * value).toFixed(1)} %`
    t.note(
      `left of ${BACK} frames before: TRAA ${percent(sharp)}, TAAU ${percent(upscaled)}; ` +
        `without either ${percent(none)}, with velocities of three's alone ${percent(still)}`
    )
    for (const [name, left] of [
      ['TRAA', sharp],
      ['TAAU', upscaled],
      ['neither', none]
    ] as const)
      expectTrue(Math.abs(left) < MOST, `${percent(left)} are left under ${name}`)
    expectTrue(still > 2 * MOST, `a trail is not found: ${percent(still)}`)
  },
  { backends: ['webgpu'] }
)
