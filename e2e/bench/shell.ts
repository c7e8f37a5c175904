import {
  AtmosphereParameters,
  AtmosphereShell,
  type AtmosphereShellOptions
} from '@welkin/atmosphere'
import { HalfFloatType, PerspectiveCamera, RenderTarget, Scene, Vector3 } from 'three'
import type { HeadlessDevice } from '../headless/device'
import { gpuMilliseconds } from '../headless/device'
import { median } from './statistics'

/** GPU time of a body's air that fills the screen [ms], seen from space and from within. */
export interface ShellCost {
  model: 'tables' | 'single-scattering'
  outsideMs: number
  insideMs: number
}

const WARM_UP = 15

async function time(
  device: HeadlessDevice,
  [width, height]: readonly [number, number],
  frames: number,
  model: ShellCost['model'],
  distance: number
): Promise<number> {
  const renderer = await device.renderer(width, height)
  const options: AtmosphereShellOptions = { sun: new Vector3(1, 0.8, 0.3), model }
  const shell = new AtmosphereShell(new AtmosphereParameters(), 1, options)
  if (shell === null) throw new Error('bench: the Earth has no air')
  const scene = new Scene().add(shell)
  const camera = new PerspectiveCamera(50, width / height, 1e-6, 10)
  camera.position.y = distance
  // From space straight down, the ground fills the picture; from within the sky does.
  camera.rotation.x = distance > 1.02 ? -Math.PI / 2 : 0.45
  camera.updateMatrixWorld()
  const target = new RenderTarget(width, height, { type: HalfFloatType })
  renderer.setRenderTarget(target)
  const times = { with: [] as number[], without: [] as number[] }
  for (const [kind, list] of Object.entries(times)) {
    shell.visible = kind === 'with'
    for (let frame = 0; frame < WARM_UP + frames; frame++) {
      renderer.render(scene, camera)
      const elapsed = await gpuMilliseconds(renderer)
      if (frame >= WARM_UP) list.push(elapsed)
    }
  }
  renderer.setRenderTarget(null)
  shell.dispose()
  target.dispose()
  void renderer.dispose()
  return median(times.with) - median(times.without)
}

/** Cost of shells of both models. */
export async function timeShells(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number
): Promise<ShellCost[]> {
  const costs: ShellCost[] = []
  for (const model of ['tables', 'single-scattering'] as const) {
    const outsideMs = await time(device, size, frames, model, 1.3)
    const insideMs = await time(device, size, frames, model, 1.0003)
    costs.push({ model, outsideMs, insideMs })
  }
  return costs
}
