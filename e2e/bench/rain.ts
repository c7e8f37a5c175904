import {
  aerialPerspective,
  Atmosphere,
  precipitationOverlay,
  PrecipitationShelter,
  rainfall,
  SkyLightProbe,
  snowfall,
  SunDirectionalLight
} from '@welkin/atmosphere'
import { HalfFloatType, MeshStandardMaterial, PerspectiveCamera, RenderTarget, Scene } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { createHouses } from '../../stories/src/street/houses'
import {
  gpuMilliseconds,
  gpuPasses,
  nextFrame,
  release,
  type HeadlessDevice
} from '../headless/device'
import { median } from './statistics'

const WARM_UP = 15

/** Rain or snow in a street with four lamps. */
interface Falling {
  readonly name: string
  /** Rates of water [mm/h]. */
  readonly rain?: number
  readonly snow?: number
  readonly isInScene?: boolean
  readonly maxParticles?: number
}

const cases: readonly Falling[] = [
  { name: 'rain, 25 mm/h', rain: 25 },
  { name: 'rain, 25 mm/h, in the scene', rain: 25, isInScene: true },
  { name: 'rain, 25 mm/h, 16,384 a class', rain: 25, maxParticles: 16_384 },
  { name: 'rain, 0 mm/h', rain: 0 },
  { name: 'snow, 2.5 mm/h', snow: 2.5 }
]

/** GPU time of what falls near the camera [ms]. */
export interface RainCost {
  name: string
  withoutMs: number
  addedMs: number
  /** The passes of a frame. */
  passes: number[]
}

async function timeStreet(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number,
  falling: Falling
): Promise<{ ms: number; passes: number[] }> {
  const renderer = await device.renderer(...size, { reversedDepthBuffer: true })
  const atmosphere = new Atmosphere().setSunAngles(25, 200)
  const scene = new Scene()
  const camera = new PerspectiveCamera(50, size[0] / size[1], 0.1, 4000)
  camera.position.set(0.6, 1.7, 4)
  camera.lookAt(-0.4, 2.6, -12)
  const houses = createHouses(new MeshStandardMaterial({ color: '#4a4a48' }))
  const sun = new SunDirectionalLight(atmosphere, 80)
  const sky = new SkyLightProbe(atmosphere)
  scene.add(sun, sun.target, sky, houses.object, camera)
  houses.light(1, atmosphere.luminanceScale)
  const shelter = new PrecipitationShelter(scene)
  const scenePass = pass(scene, camera, { samples: 0 })
  const depth = scenePass.getTextureNode('depth')
  const air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere)
  const { rain, snow, isInScene, maxParticles } = falling
  const options = { lights: [sun, sky, ...houses.lamps], shelter, time: 60, maxParticles }
  const hidden = isInScene ? options : { ...options, depth, depthCamera: camera }
  const drawn = [
    ...(rain === undefined ? [] : [rainfall(atmosphere, { ...hidden, rate: rain })]),
    ...(snow === undefined ? [] : [snowfall(atmosphere, { ...hidden, rate: snow })])
  ]
  if (isInScene) scene.add(...drawn)
  const isOver = drawn.length > 0 && !isInScene
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputNode = isOver ? precipitationOverlay(air, camera, drawn) : air
  const target = new RenderTarget(...size, { type: HalfFloatType, depthBuffer: false })
  const times: number[] = []
  for (let frame = 0; frame < WARM_UP + frames; frame++) {
    nextFrame()
    renderer.setRenderTarget(target)
    pipeline.render()
    renderer.setRenderTarget(null)
    const ms = await gpuMilliseconds(renderer)
    if (frame >= WARM_UP) times.push(ms)
  }
  const passes = gpuPasses(renderer)
  for (const owned of [...drawn, shelter, pipeline, scenePass, target, houses, sun, atmosphere])
    owned.dispose()
  release(renderer)
  return { ms: median(times), passes }
}

/** Times rain and snow around the camera: the difference to the same street without. */
export async function timeRain(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number
): Promise<RainCost[]> {
  const costs: RainCost[] = []
  const without = await timeStreet(device, size, frames, { name: 'none' })
  for (const falling of cases) {
    const { ms, passes } = await timeStreet(device, size, frames, falling)
    const addedMs = ms - without.ms
    costs.push({ name: falling.name, withoutMs: without.ms, addedMs, passes })
  }
  return costs
}

/** A line of a report. */
export const rainLine = ({ name, withoutMs, addedMs, passes }: RainCost): string =>
  `${name.padEnd(34)} ${addedMs.toFixed(3)} ms   (without ${withoutMs.toFixed(3)} ms; ` +
  `passes ${passes.map(ms => ms.toFixed(3)).join(' ')})`
