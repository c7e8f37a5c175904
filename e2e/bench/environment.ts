import {
  HalfFloatType,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  RenderTarget,
  Scene,
  SphereGeometry
} from 'three'
import { Atmosphere, skyBackground, skyEnvironment } from '@welkin/atmosphere'
import { gpuMilliseconds, type HeadlessDevice } from '../headless/device'
import { median } from './statistics'

/** Cost of drawing the environment anew. */
export interface EnvironmentCost {
  /** The most that it adds to a frame, GPU [ms]. */
  mostMs: number
  /** All of its frames together, GPU [ms]. */
  totalMs: number
  /** The most that a frame of it takes to submit, CPU [ms]. */
  submitMs: number
}

/**
 * Moves the sun and times each frame until the environment is drawn anew; frames that only compute a sky
 * volume for the sun are taken off.
 */
export async function timeEnvironment(
  device: HeadlessDevice,
  size: readonly [number, number],
  rebuilds: number
): Promise<EnvironmentCost> {
  const renderer = await device.renderer(...size)
  const atmosphere = new Atmosphere().setSunAngles(30, 120)
  const scene = new Scene()
  scene.backgroundNode = skyBackground(atmosphere)
  const environment = skyEnvironment(atmosphere)
  scene.environmentNode = environment
  const ball = new Mesh(
    new SphereGeometry(1, 64, 32),
    new MeshStandardMaterial({ metalness: 1, roughness: 0.3 })
  )
  scene.add(ball)
  const camera = new PerspectiveCamera(50, size[0] / size[1], 0.1, 100)
  camera.position.z = 4
  const target = new RenderTarget(...size, { type: HalfFloatType })

  const frame = async (): Promise<{ gpu: number; cpu: number }> => {
    const start = performance.now()
    renderer.setRenderTarget(target)
    renderer.render(scene, camera)
    renderer.setRenderTarget(null)
    const cpu = performance.now() - start
    return { gpu: await gpuMilliseconds(renderer), cpu }
  }
  for (let i = 0; i < 15; i++) await frame()
  const still: number[] = []
  for (let i = 0; i < 20; i++) still.push((await frame()).gpu)
  const base = median(still)

  const runs: EnvironmentCost[] = []
  for (let rebuild = 0; rebuild < rebuilds + 2; rebuild++) {
    // The volume for the new sun first, by itself.
    environment.angle = 180
    atmosphere.setSunAngles(31 + rebuild * 0.5, 120)
    await frame()
    environment.angle = 0.1
    const before = environment.redraws
    const steps: { gpu: number; cpu: number }[] = []
    while (environment.redraws === before) steps.push(await frame())
    const costs = steps.map(({ gpu }) => gpu - base)
    // Two to warm up.
    if (rebuild < 2) continue
    runs.push({
      mostMs: Math.max(...costs),
      totalMs: costs.reduce((sum, cost) => sum + cost, 0),
      submitMs: Math.max(...steps.map(({ cpu }) => cpu))
    })
  }
  environment.dispose()
  atmosphere.dispose()
  ball.geometry.dispose()
  ball.material.dispose()
  target.dispose()
  void renderer.dispose()
  return {
    mostMs: median(runs.map(run => run.mostMs)),
    totalMs: median(runs.map(run => run.totalMs)),
    submitMs: median(runs.map(run => run.submitMs))
  }
}
