import { cloudQualities } from '@welkin/clouds'
import { expectLight } from '../harness/atmosphere'
import { CloudyStage, SAMPLES, type Temporal } from '../harness/cloudy-stage'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'
import { psnr } from '../harness/supersample'
import { trailOf } from '../harness/trails'

const size = { width: 96, height: 54 }
/** Frames in which TRAA converges, and turn of a frame [rad]. */
const FRAMES = 40
const TURN = 0.012
const TURNS = 12
/** Frames before the last to the picture of which a trail is looked for, and most of it that may be left. */
const BACK = 3
const MOST_LEFT = 0.05
/** Frames in which the exact picture settles. */
const SETTLING = 12
/** Part of a picture of 960×540 pixels and 60°, in which clouds are as large as there; frames in which they settle, and those of the exact picture. */
const part = { width: 48, height: 27, field: 3, frames: 128, exactFrames: 24 } as const

gpuTest(
  'under TRAA a still picture with clouds is as sharp as a supersampled one; a turning one has no trails, under TAAU neither',
  async t => {
    const renderer = await t.createRenderer(size)
    const exact = new CloudyStage(renderer, 'none')
    await exact.bake()
    const supersampled = async (angle: number): Promise<Picture> => {
      exact.turn(angle)
      for (let i = 0; i < SETTLING; i++) await exact.draw()
      return exact.supersample(size)
    }
    const still = await supersampled(0)
    expectLight(still, 'supersampled')
    const turned = await supersampled(TURN * TURNS)
    const earlier = await supersampled(TURN * (TURNS - BACK))
    const later = await supersampled(TURN * (TURNS + BACK))
    exact.dispose()

    /** Picture at rest, and in turning. */
    const shown = async (temporal: Temporal): Promise<[still: Picture, turning: Picture]> => {
      const stage = new CloudyStage(renderer, temporal)
      await stage.bake()
      stage.turn(0)
      let drawn = await stage.draw()
      for (let i = 1; i < FRAMES; i++) drawn = await stage.draw()
      const first = drawn
      for (let i = 1; i <= TURNS; i++) {
        stage.turn(TURN * i)
        drawn = await stage.draw()
      }
      expectLight(drawn, `turning, ${temporal}`)
      stage.dispose()
      return [first, drawn]
    }
    const [rested, moved] = await shown('traa')
    const [, upscaled] = await shown('taau')
    const [sharp, turning] = [psnr(rested, still), psnr(moved, turned)]
    const [left, leftUpscaled] = [moved, upscaled].map(drawn =>
      trailOf(drawn, turned, earlier, later)
    )
    const percent = (value: number): string => `${(100 * value).toFixed(1)} %`
    t.note(
      `still ${sharp.toFixed(1)} dB, turning ${turning.toFixed(1)} dB; left of ${BACK} frames before ` +
        `${percent(left)}, under TAAU ${percent(leftUpscaled)}`
    )
    expectTrue(sharp >= 36, `still ${sharp} dB`)
    // With three's velocities alone, in which sky and clouds stand still, there are 3 dB less, and 35 % are left.
    expectTrue(turning >= 27, `turning ${turning} dB`)
    expectTrue(Math.abs(left) < MOST_LEFT, `${percent(left)} are left`)
    expectTrue(Math.abs(leftUpscaled) < MOST_LEFT, `${percent(leftUpscaled)} are left under TAAU`)
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'at the default quality a still picture under TRAA is as sharp as a supersampled one that marches every pixel',
  async t => {
    const renderer = await t.createRenderer(part)
    const { high } = cloudQualities
    const exact = new CloudyStage(renderer, 'none', {
      quality: { ...high, block: 1 },
      field: part.field
    })
    await exact.bake()
    exact.turn(0)
    for (let i = SAMPLES; i < part.exactFrames; i++) await exact.draw()
    const still = await exact.supersample(part)
    expectLight(still, 'supersampled')
    exact.dispose()
    const stage = new CloudyStage(renderer, 'traa', { quality: high, field: part.field })
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
