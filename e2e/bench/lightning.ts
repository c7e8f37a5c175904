import { cloudPreset, lightning } from '@welkin/clouds'
import { Vector3 } from 'three'
import { release, type HeadlessDevice } from '../headless/device'
import { CloudBench, cloudViews, type FrameTimes } from './CloudBench'
import { median } from './statistics'

/** Distance of the flash from the camera [m]. */
const DISTANCE = 6000

/** Times that frames without and with the flash are timed in turn, and frames before each: a GPU's clock drifts within a second. */
const ROUNDS = 4
const SETTLING = 4

/** GPU time of a storm by night [ms]. */
export interface LightningCost {
  name: string
  /** Frame with clouds alone. */
  withoutMs: number
  /** Time that lightning adds between flashes, to within the clock's drift, and what a flash adds to that. */
  darkMs: number
  flashMs: number
  /** Passes of a frame without a flash, and with one. */
  darkPasses: number[]
  passes: number[]
}

const middleOf = (rounds: readonly FrameTimes[]): FrameTimes => ({
  ms: median(rounds.map(({ ms }) => ms)),
  passes: rounds[0].passes.map((_, i) => median(rounds.map(({ passes }) => passes[i])))
})

/** Times a flash to the ground in front of the camera, under and beside a storm. */
export async function timeLightning(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number
): Promise<LightningCost[]> {
  const costs: LightningCost[] = []
  for (const view of [cloudViews[0], cloudViews[3]]) {
    const renderer = await device.renderer(...size, { reversedDepthBuffer: true })
    const bench = new CloudBench(renderer, size, cloudPreset('cumulonimbus'))
    bench.look(view, -25)
    bench.withClouds = true
    const { node } = bench
    const without = await bench.time(frames, true)
    const storm = lightning(node, { limit: null, exposure: 0.5, time: 0 })
    bench.withClouds = true
    const at = new Vector3(0, 0, -DISTANCE).applyMatrix4(node.camera.matrixWorld)
    storm.addEventListener('strike', () => (storm.time = 0.5))
    storm.strike({ kind: 'ground', at })
    await bench.time(1, true)
    if (!storm.isFlashing) throw new Error('lightning: nothing flashes')
    const rounds: Record<'dark' | 'lit', FrameTimes[]> = { dark: [], lit: [] }
    for (let round = 0; round < ROUNDS; round++) {
      for (const kind of ['dark', 'lit'] as const) {
        storm.enabled = kind === 'lit'
        rounds[kind].push(await bench.time(frames, true, SETTLING))
      }
    }
    const [dark, flash] = [middleOf(rounds.dark), middleOf(rounds.lit)]
    costs.push({
      name: view.name,
      withoutMs: without.ms,
      darkMs: dark.ms - without.ms,
      flashMs: flash.ms - dark.ms,
      darkPasses: dark.passes,
      passes: flash.passes
    })
    storm.dispose()
    bench.dispose()
    release(renderer)
  }
  return costs
}

const line = (passes: number[]): string => passes.map(ms => ms.toFixed(3)).join(' ')

/** A line of a report. */
export const lightningLine = ({
  name,
  withoutMs,
  darkMs,
  flashMs,
  darkPasses,
  passes
}: LightningCost): string =>
  `lightning, ${name.padEnd(8)} dark ${darkMs.toFixed(3)} ms   a flash adds ${flashMs.toFixed(3)} ms   (without ${withoutMs.toFixed(3)} ms; passes ${line(darkPasses)}; with a flash ${line(passes)})`
