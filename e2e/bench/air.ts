import { median } from './statistics'
import { finished, gpuMilliseconds, type HeadlessDevice } from '../headless/device'
import { timeFrame } from './frame'
import { benchScene, type Path } from './scene'

const ALTITUDES = [2, 1e3, 1e4, 4e5, 2e7]
export const PATHS: readonly Path[] = ['forward', 'post']

/** Cost of sky and haze at one altitude. */
export interface AirCost {
  path: Path
  altitude: number
  compositeMs: number
  volumeUpdateMs: number
  /** GPU time of the scene without air [ms]. */
  sceneMs: number
  /** CPU time of a frame in which the volume is updated [ms]. */
  cpuMs: number
}

/** A line of a report. */
export function airLine({ path, altitude, compositeMs, volumeUpdateMs, sceneMs }: AirCost): string {
  return (
    `${path.padEnd(8)} ${String(altitude).padStart(9)} m   composite ${compositeMs.toFixed(3)} ms` +
    `   volume update ${volumeUpdateMs.toFixed(3)} ms   (scene alone ${sceneMs.toFixed(3)} ms)`
  )
}

/** Cost of sky and haze as a post effect and in the forward path, from the ground to orbit. */
export async function timeAir(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number
): Promise<AirCost[]> {
  const costs: AirCost[] = []
  for (const path of PATHS) {
    for (const altitude of ALTITUDES) {
      const at = { path, altitude }
      const without = await timeFrame(device, size, frames, { ...at, withAir: false })
      const still = await timeFrame(device, size, frames, at)
      const moving = await timeFrame(device, size, frames, { ...at, sunMoves: true })
      const compositeMs = still.gpu - without.gpu
      const volumeUpdateMs = moving.gpu - still.gpu
      const cpuMs = moving.cpu - without.cpu
      costs.push({ ...at, compositeMs, volumeUpdateMs, sceneMs: without.gpu, cpuMs })
    }
  }
  return costs
}

/** Size of a texel of the tables [bytes]. */
const HALF_FLOATS = 8

/** GPU time of a bake, one step a frame: in all, and the most in a frame. */
export async function timeBake(
  device: HeadlessDevice
): Promise<{ total: number; most: number; bytes: number }> {
  const runs: { total: number; most: number; bytes: number }[] = []
  for (let run = 0; run < 5; run++) {
    const renderer = await device.renderer(64, 36)
    const scene = benchScene(renderer, 'forward', 2, true, [64, 36])
    scene.draw()
    await gpuMilliseconds(renderer)
    scene.draw()
    const still = await gpuMilliseconds(renderer)
    scene.atmosphere.bakeStepsPerFrame = 1
    scene.atmosphere.parameters.set({})
    const steps: number[] = []
    const { tables } = scene.atmosphere
    for (const before = tables.version; tables.version === before;) {
      scene.draw()
      steps.push((await gpuMilliseconds(renderer)) - still)
    }
    const total = steps.reduce((sum, value) => sum + value, 0)
    const bytes = [tables.atlas.target, tables.volumes.segments]
      .map(({ width, height, textures }) => HALF_FLOATS * width * height * textures.length)
      .reduce((sum, value) => sum + value, 0)
    runs.push({ total, most: Math.max(...steps), bytes })
    scene.dispose()
    void renderer.dispose()
  }
  return {
    total: median(runs.map(run => run.total)),
    most: Math.max(...runs.map(run => run.most)),
    bytes: runs[0].bytes
  }
}

/** Time to the first finished frame, from no renderer on, tables baked; wall-clock. */
export async function timeFirstFrame(device: HeadlessDevice): Promise<number> {
  const start = performance.now()
  const renderer = await device.renderer(320, 180)
  const scene = benchScene(renderer, 'forward', 2, true, [320, 180])
  scene.draw()
  await finished(renderer)
  const elapsed = performance.now() - start
  scene.dispose()
  void renderer.dispose()
  return elapsed
}
