import { CloudNoise, cloudPreset, cloudQualities } from '@welkin/clouds'
import type { CloudLayers, CloudQuality, CloudQualityName } from '@welkin/clouds'
import { gpuMilliseconds, release, type HeadlessDevice } from '../headless/device'
import { CloudBench, cloudViews, type CloudView } from './CloudBench'
import { median } from './statistics'

/** Case that is timed and compared with the reference. */
interface CloudCase {
  name: string
  view: CloudView
  /** Layers; default: cumulus that cover 0.4 of the sky. */
  layers?: () => CloudLayers
  /** Elevation of the sun [°], default 40. */
  sunElevation?: number
  qualities: readonly CloudQualityName[]
}

const everyQuality = ['low', 'medium', 'high', 'ultra'] as const
const [ground] = cloudViews

/** Showers that bring rain to the view from the ground, near and far. */
export function shower(): CloudLayers {
  const layers = cloudPreset('shower')
  layers.at(0).set({ coverage: 0.6 })
  return layers
}

function dryShower(): CloudLayers {
  const layers = shower()
  layers.at(0).set({ precipitation: null })
  return layers
}

const cloudCases: readonly CloudCase[] = [
  ...cloudViews.map(view => ({ name: view.name, view, qualities: everyQuality })),
  { name: 'low sun', view: ground, sunElevation: 4, qualities: everyQuality },
  {
    name: 'congestus',
    view: ground,
    layers: () => cloudPreset('congestus'),
    qualities: ['medium', 'high']
  },
  {
    name: 'cumulonimbus',
    view: ground,
    layers: () => cloudPreset('cumulonimbus'),
    qualities: ['medium', 'high']
  },
  {
    name: 'mixed',
    view: ground,
    layers: () => cloudPreset('mixed'),
    qualities: ['medium', 'high']
  },
  { name: 'shower', view: ground, layers: shower, qualities: ['high'] },
  { name: 'shower, dry', view: ground, layers: dryShower, qualities: ['high'] }
]

/** Cost of clouds in one case at one quality. */
export interface CloudCost {
  name: string
  quality: CloudQualityName
  /** GPU time of the clouds alone: with them less without [ms]. */
  ms: number
  /** The largest passes, in the order in which they are drawn [ms]. */
  passes: number[]
  /** Peak signal-to-noise ratio of a settled picture against `cloudReference` [dB]. */
  psnr: number
  /** PSNR in the midst of a turn of 30°/s, and of a flight at 60 m/s, at 60 frames a second [dB]. */
  turningPsnr: number
  flyingPsnr: number
  /** Mean change of a channel from frame to frame of the settled picture [levels of 255]. */
  flicker: number
}

/** Frames of a move, and what the camera turns [°] or goes on [m] in each. */
const MOVING = 60
const TURN = 30 / 60
const FLIGHT = 60 / 60

/** Frames between which flicker is measured. */
const FLICKERING = 5

/** Frames in which a picture that stands still settles: two seconds. */
const SETTLING = 120

/** Slices of noise that a node draws in a frame, and frames that this takes. */
const NOISE_SLICES = 12
const NOISE_FRAMES = 20

/** Every pixel, with an eighth of the steps' length of `high`, without history. */
export const cloudReference: CloudQuality = {
  steps: 1024,
  stepGrowth: cloudQualities.high.stepGrowth / 8,
  shortestStep: cloudQualities.high.shortestStep / 8,
  depthStep: cloudQualities.high.depthStep / 8,
  layerSteps: cloudQualities.high.layerSteps * 8,
  lightSteps: 4,
  block: 1
}

/** `CloudField.skipping` of the reference. */
export const REFERENCE_SKIPPING = 0.25

/** Peak signal-to-noise ratio of colours in [0, 255] [dB]. */
export function psnr(a: Uint8Array, b: Uint8Array): number {
  let sum = 0
  for (let i = 0; i < a.length; i++) if (i % 4 < 3) sum += (a[i] - b[i]) ** 2
  return 10 * Math.log10(255 ** 2 / (sum / (0.75 * a.length)))
}

/** Mean difference of colours in [0, 255] [levels]. */
export function meanDifference(a: Uint8Array, b: Uint8Array): number {
  let sum = 0
  for (let i = 0; i < a.length; i++) if (i % 4 < 3) sum += Math.abs(a[i] - b[i])
  return sum / (0.75 * a.length)
}

/** Flicker of what stands still. */
async function flickerOf(bench: CloudBench): Promise<number> {
  let [sum, before] = [0, await bench.picture()]
  for (let i = 1; i < FLICKERING; i++) {
    bench.draw(true)
    const picture = await bench.picture()
    sum += meanDifference(before, picture)
    before = picture
  }
  return sum / (FLICKERING - 1)
}

/** Picture at the end of a move that ends where the camera looks from: `turn` [°] and `back` [m] a frame. */
async function moved(bench: CloudBench, turn: number, back: number): Promise<Uint8Array> {
  for (let left = MOVING; left >= 0; left--) {
    bench.displace(left * turn, left * back)
    bench.draw(true)
  }
  return bench.picture()
}

/** Cost of one case at each of its qualities. */
async function timeCase(
  bench: CloudBench,
  { name, view, sunElevation, qualities }: CloudCase,
  frames: number
): Promise<CloudCost[]> {
  const { node } = bench
  bench.look(view, sunElevation)
  bench.withClouds = false
  const without = await bench.time(Math.min(frames, 5))
  bench.withClouds = true
  node.accumulates = false
  node.quality = cloudReference
  node.field.skipping.value = REFERENCE_SKIPPING
  // Each of the shadow maps, at least once.
  for (let i = 0; i < 4; i++) bench.draw(true)
  const reference = await bench.picture()
  node.accumulates = true
  node.field.skipping.value = 1
  const costs: CloudCost[] = []
  for (const quality of qualities) {
    node.quality = quality
    const { ms, passes } = await bench.time(frames)
    for (let i = 0; i < SETTLING; i++) bench.draw(true)
    const settled = psnr(await bench.picture(), reference)
    const flicker = await flickerOf(bench)
    const turningPsnr = psnr(await moved(bench, TURN, 0), reference)
    const flyingPsnr = psnr(await moved(bench, 0, FLIGHT), reference)
    const still = { psnr: settled, flicker }
    costs.push({ name, quality, ms: ms - without.ms, passes, ...still, turningPsnr, flyingPsnr })
  }
  return costs
}

/**
 * Cost of clouds in every case, and how near each comes to the reference; `tell` gets each at once.
 *
 * @param prefix - Beginning of the names of the cases that are timed.
 */
export async function timeClouds(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number,
  tell: (cost: CloudCost) => void,
  prefix = ''
): Promise<CloudCost[]> {
  const renderer = await device.renderer(...size)
  const costs: CloudCost[] = []
  const cases = cloudCases.filter(({ name }) => name.startsWith(prefix))
  for (const layers of new Set(cases.map(timed => timed.layers))) {
    const own = cases.filter(other => other.layers === layers)
    const bench = new CloudBench(renderer, size, layers?.())
    for (const timed of own) {
      const timings = await timeCase(bench, timed, frames)
      timings.forEach(tell)
      costs.push(...timings)
    }
    bench.dispose()
  }
  void renderer.dispose()
  return costs
}

/** GPU time of the noise, drawn in slices as a node does: in all, and the most in a frame [ms]. */
export async function timeNoise(device: HeadlessDevice): Promise<{ total: number; most: number }> {
  const renderer = await device.renderer(64, 36)
  const runs: { total: number; most: number }[] = []
  for (let run = 0; run < 3; run++) {
    const noise = new CloudNoise()
    const times: number[] = []
    for (let isReady = false; !isReady && times.length < 10 * NOISE_FRAMES;) {
      isReady = noise.update(renderer, NOISE_SLICES)
      times.push(await gpuMilliseconds(renderer))
    }
    runs.push({ total: times.reduce((sum, ms) => sum + ms, 0), most: Math.max(...times) })
    noise.dispose()
  }
  release(renderer)
  return { total: median(runs.map(run => run.total)), most: median(runs.map(run => run.most)) }
}

/** A line of a report. */
export function cloudLine(cost: CloudCost): string {
  const { name, quality, ms, passes, psnr, turningPsnr, flyingPsnr, flicker } = cost
  const each = passes.map(pass => pass.toFixed(2)).join(' ')
  const [still, turning, flying] = [psnr, turningPsnr, flyingPsnr].map(value => value.toFixed(1))
  return (
    `clouds, ${name.padEnd(20)} ${quality.padEnd(7)} ${ms.toFixed(3)} ms (all passes: ${each})` +
    `   PSNR ${still} dB, turning ${turning}, flying ${flying}   flicker ${flicker.toFixed(2)} levels`
  )
}
