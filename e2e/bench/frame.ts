import type { Atmosphere } from '@welkin/atmosphere'
import { gpuMilliseconds, release, type HeadlessDevice } from '../headless/device'
import { benchScene, setSun, type Path } from './scene'
import { median } from './statistics'

const WARM_UP = 15

/** Frame that is drawn and timed. */
export interface FrameCase {
  path: Path
  /** Altitude of the camera [m]. */
  altitude: number
  /** False for the same scene without air, to be subtracted. */
  withAir?: boolean
  /** True if the sun moves on every frame, so that the sky volume is computed anew. */
  sunMoves?: boolean
  /** Adds what else is in the sky. */
  decorate?: (atmosphere: Atmosphere) => void
  /** Elevation of the sun [°]. */
  elevation?: number
}

/** GPU milliseconds of one frame, median after warm-up; and CPU milliseconds to submit it. */
export async function timeFrame(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number,
  { path, altitude, withAir = true, sunMoves = false, decorate, elevation }: FrameCase
): Promise<{ gpu: number; cpu: number }> {
  const renderer = await device.renderer(...size)
  const scene = benchScene(renderer, path, altitude, withAir, size, decorate)
  if (elevation !== undefined) setSun(scene.atmosphere, scene.camera, elevation)
  const gpu: number[] = []
  const cpu: number[] = []
  for (let frame = 0; frame < WARM_UP + frames; frame++) {
    if (sunMoves) setSun(scene.atmosphere, scene.camera, 30 + frame * 0.05)
    const start = performance.now()
    scene.draw()
    const submitted = performance.now() - start
    const elapsed = await gpuMilliseconds(renderer)
    if (frame >= WARM_UP) {
      gpu.push(elapsed)
      cpu.push(submitted)
    }
  }
  scene.dispose()
  release(renderer)
  return { gpu: median(gpu), cpu: median(cpu) }
}
