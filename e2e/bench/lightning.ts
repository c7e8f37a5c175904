import { cloudPreset, lightning } from '@welkin/clouds'
import { Vector3 } from 'three'
import { release, type HeadlessDevice } from '../headless/device'
import { CloudBench, cloudViews, type FrameTimes } from './CloudBench'
import { median } from './statistics'

/** Distance of the flash from the camera [m]. */
const DISTANCE = 6000

/** Times that frames of each kind are timed in turn, every other time in reverse, and frames before each: a GPU's clock drifts within a second. */
const ROUNDS = 4
const SETTLING = 4

/** Frames: of clouds alone, between flashes, and with a flash. */
const KINDS = ['without', 'dark', 'lit'] as const

/** GPU time of a storm by night [ms]. */
export interface LightningCost {
  name: string
  /** Frame with clouds alone. */
  withoutMs: number
  /** Time that lightning adds between flashes, and what a flash adds to that. */
  darkMs: number
  flashMs: number
  /** Passes of a frame with clouds alone, of one between flashes, and of one with a flash. */
  withoutPasses: number[]
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
    const { node } = bench
    const storm = lightning(node, { limit: null, exposure: 0.5, time: 0 })
    bench.withClouds = true
    const at = new Vector3(0, 0, -DISTANCE).applyMatrix4(node.camera.matrixWorld)
    storm.addEventListener('strike', () => (storm.time = 0.5))
    storm.strike({ kind: 'ground', at })
    await bench.time(1, true)
    if (!storm.isFlashing) throw new Error('lightning: nothing flashes')
    const rounds: Record<(typeof KINDS)[number], FrameTimes[]> = { without: [], dark: [], lit: [] }
    for (let round = 0; round < ROUNDS; round++) {
      for (const kind of round % 2 === 0 ? KINDS : KINDS.toReversed()) {
        storm.enabled = kind === 'lit'
        if (kind === 'without') node.screens.delete(storm)
        else node.screens.add(storm)
        bench.withClouds = true
        rounds[kind].push(await bench.time(frames, true, SETTLING))
      }
    }
    const [alone, dark, flash] = KINDS.map(kind => middleOf(rounds[kind]))
    costs.push({
      name: view.name,
      withoutMs: alone.ms,
      darkMs: dark.ms - alone.ms,
      flashMs: flash.ms - dark.ms,
      withoutPasses: alone.passes,
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
  withoutPasses,
  darkPasses,
  passes
}: LightningCost): string =>
  `lightning, ${name.padEnd(8)} dark ${darkMs.toFixed(3)} ms   a flash adds ${flashMs.toFixed(3)} ms   (without ${withoutMs.toFixed(3)} ms; passes ${line(withoutPasses)}; between flashes ${line(darkPasses)}; with a flash ${line(passes)})`
