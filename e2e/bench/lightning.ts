import { cloudPreset, lightning } from '@welkin/clouds'
import { Vector3 } from 'three'
import { release, type HeadlessDevice } from '../headless/device'
import { CloudBench, cloudViews } from './CloudBench'

/** Distance of the flash from the camera [m]. */
const DISTANCE = 6000

/** GPU time of a storm by night [ms]. */
export interface LightningCost {
  name: string
  /** Frame with clouds alone. */
  withoutMs: number
  /** Time that lightning adds between flashes, and while one is seen. */
  darkMs: number
  flashMs: number
  /** Passes of a frame without a flash, and with one. */
  darkPasses: number[]
  passes: number[]
}

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
    const dark = await bench.time(frames, true)
    const at = new Vector3(0, 0, -DISTANCE).applyMatrix4(node.camera.matrixWorld)
    storm.addEventListener('strike', () => (storm.time = 0.5))
    storm.strike({ kind: 'ground', at })
    const flash = await bench.time(frames, true)
    if (!storm.isFlashing) throw new Error('lightning: nothing flashes')
    const { ms } = without
    costs.push({
      name: view.name,
      withoutMs: ms,
      darkMs: dark.ms - ms,
      flashMs: flash.ms - ms,
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
  `lightning, ${name.padEnd(8)} dark ${darkMs.toFixed(3)} ms   flash ${flashMs.toFixed(3)} ms   (without ${withoutMs.toFixed(3)} ms; passes ${line(darkPasses)}; with a flash ${line(passes)})`
