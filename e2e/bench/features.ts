import { photographicToneMapping } from '@welkin/atmosphere'
import { CustomToneMapping, RenderTarget } from 'three'
import { FeatureMeter, type FeatureShare } from '../../stories/src/valley/FeatureMeter'
import { meteredFeatures } from '../../stories/src/valley/meteredFeatures'
import { openingState } from '../../stories/src/valley/openingState'
import { Valley, type ValleyState } from '../../stories/src/valley/Valley'
import { gpuMilliseconds, nextFrame, release, type HeadlessDevice } from '../headless/device'
import { rowsOf } from './rows'

/** Time of a frame on the scene's clock [s]. */
const STEP = 1 / 30

/** Frames before the first feature is switched off. */
const FIRST_FRAMES = 40

const STATES: Readonly<Record<string, Partial<ValleyState>>> = {
  day: {},
  night: { date: Date.UTC(2026, 8, 26), hour: 22.5 },
  shower: { weather: 'shower', hour: 12.3 }
}

/** GPU time of the valley in a state, and what frames take less without each of its features [ms]. */
export interface FeatureCost {
  name: string
  gpuMs: number
  shares: readonly FeatureShare[]
}

/**
 * Measures the features of the valley at medium quality as its readout does: each is switched off for a while.
 *
 * @param only - States, by name; all if there are none.
 * @throws If a name is of no state.
 */
export async function measureFeatures(
  device: HeadlessDevice,
  [width, height]: readonly [number, number],
  only: readonly string[],
  log: (text: string) => void
): Promise<FeatureCost[]> {
  const asked = rowsOf('features', Object.keys(STATES), only)
  const renderer = await device.renderer(width, height, { reversedDepthBuffer: true })
  renderer.highPrecision = true
  renderer.shadowMap.enabled = true
  renderer.library.addToneMapping(photographicToneMapping(), CustomToneMapping)
  renderer.toneMapping = CustomToneMapping
  const target = new RenderTarget(width, height, { depthBuffer: false })
  const base: ValleyState = { ...openingState, paused: true }
  const valley = new Valley(renderer, base)
  await valley.bake(renderer)
  valley.camera.aspect = width / height
  valley.camera.updateProjectionMatrix()
  valley.lookFrom('village')
  let time = 100
  const draw = async (): Promise<number> => {
    nextFrame()
    valley.time = time += STEP
    renderer.setRenderTarget(target)
    valley.render(STEP)
    renderer.setRenderTarget(null)
    return gpuMilliseconds(renderer)
  }
  const costs: FeatureCost[] = []
  for (const [name, changes] of Object.entries(STATES)) {
    if (!asked.has(name)) continue
    const state = { ...base, ...changes }
    valley.set(state, true)
    for (let i = 0; i < FIRST_FRAMES; i++) {
      await draw()
      if (i % 8 === 7) await valley.exposure.settle()
    }
    const gpuMs = await draw()
    const meter = new FeatureMeter<Partial<ValleyState>>(off => valley.set({ ...state, ...off }))
    meter.start(meteredFeatures(state))
    while (meter.isMeasuring) {
      meter.take(await draw(), 1)
      meter.update(STEP)
    }
    const shares = meter.shares.toSorted((a, b) => b.milliseconds - a.milliseconds)
    log(`${name.padEnd(24)} ${gpuMs.toFixed(2)} ms; less without:`)
    for (const share of shares) {
      log(`  ${share.name.padEnd(22)} ${share.milliseconds.toFixed(3)} ms`)
    }
    costs.push({ name, gpuMs, shares })
  }
  valley.dispose()
  target.dispose()
  release(renderer)
  return costs
}
