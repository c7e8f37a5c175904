import { CloudLightTable, cloudPreset, DropletLightTable } from '@welkin/clouds'
import type { CloudLayers } from '@welkin/clouds'
import { release, type HeadlessDevice } from '../headless/device'
import { CloudBench, cloudViews, type CloudBenchOptions, type FrameTimes } from './CloudBench'
import { shower } from './clouds'
import { median } from './statistics'

/** Times that pictures without and with bows are timed in turn: a GPU's clock drifts within a second. */
const ROUNDS = 4

/** Frames before any are timed, and after each change of pictures. */
const WARM_UP = 40
const SETTLING = 3

/** GPU time of light that has the phase function of drops or droplets in place of smooth lobes [ms]. */
export interface BowCost {
  name: string
  withoutMs: number
  bowsMs: number
  /** Additional time of each pass, in the order in which they are drawn. */
  passes: number[]
}

interface BowCase {
  name: string
  layers: () => CloudLayers
  without: () => CloudBenchOptions
  bows: () => CloudBenchOptions
}

/** Lobes of the same moments as droplets have, so that as much of the clouds is seen. */
function lobesOfDroplets(): CloudLightTable {
  const droplets = new DropletLightTable()
  const { phase } = droplets
  droplets.dispose()
  return new CloudLightTable(phase)
}

const CASES: readonly BowCase[] = [
  {
    name: 'rainbows',
    layers: shower,
    without: () => ({ hasRainbows: false }),
    bows: () => ({ hasRainbows: true })
  },
  {
    name: 'cloudbow and glory',
    layers: () => cloudPreset('fairWeather'),
    without: () => ({ light: lobesOfDroplets() }),
    bows: () => ({ light: new DropletLightTable() })
  }
]

/** Times what bows add to clouds at `high`, seen from the ground; `tell` gets each at once. */
export async function timeBows(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number,
  tell: (cost: BowCost) => void
): Promise<BowCost[]> {
  const costs: BowCost[] = []
  for (const { name, layers, without, bows } of CASES) {
    const renderer = await device.renderer(...size)
    // Two of each: a pass of several milliseconds differs by hundredths between two that are alike, by where their textures lie.
    const benches = [without(), bows(), bows(), without()].map(options => {
      const bench = new CloudBench(renderer, size, layers(), options)
      bench.look(cloudViews[0])
      bench.withClouds = true
      return bench
    })
    const rounds: FrameTimes[][] = benches.map(() => [])
    for (let round = 0; round < ROUNDS; round++) {
      for (const [i, bench] of benches.entries()) {
        rounds[i].push(await bench.time(frames, true, round === 0 ? WARM_UP : SETTLING))
      }
    }
    const [before, first, second, after] = rounds.map(times => {
      const all = times.map(({ ms, passes }) => [ms, ...passes])
      return all[0].map((_, k) => median(all.map(values => values[k])))
    })
    const withoutMs = (before[0] + after[0]) / 2
    const [bowsMs, ...passes] = before.map((ms, k) => (first[k] + second[k] - ms - after[k]) / 2)
    const cost = { name, withoutMs, bowsMs, passes }
    tell(cost)
    costs.push(cost)
    for (const bench of benches) bench.dispose()
    release(renderer)
  }
  return costs
}

/** A line of a report. */
export const bowLine = ({ name, withoutMs, bowsMs, passes }: BowCost): string =>
  `${name.padEnd(20)} ${bowsMs.toFixed(3)} ms   (without ${withoutMs.toFixed(3)} ms; passes ${passes.map(ms => ms.toFixed(3)).join(' ')})`
