import {
  aerialPerspectiveFog,
  Atmosphere,
  skyBackground,
  SkyLightProbe,
  SunDirectionalLight
} from '@welkin/atmosphere'
import { MountainHeights, Terrain } from '@welkin/terrain'
import { Matrix4, PerspectiveCamera, RenderTarget, Scene } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { Vegetation } from '../../stories/src/terrain/vegetation/Vegetation'
import {
  finished,
  gpuMilliseconds,
  nextFrame,
  release,
  type HeadlessDevice
} from '../headless/device'
import { median } from './statistics'

const VIEWS = [
  { name: 'eye height', height: 2, pitch: -4 },
  { name: '1 km', height: 1e3, pitch: -10 },
  { name: '10 km', height: 1e4, pitch: -15 },
  { name: '400 km', height: 4e5, pitch: -30 }
] as const

const PLACE = { longitude: 1, latitude: 47 }
/** A clearing in woods, for the sample of vegetation. */
const MEADOW = { name: 'meadow', height: 2, pitch: -4, longitude: 0.494, latitude: 46.35 } as const

const WARM_UP = 10

/** Way flown in a frame, in heights above the ground: at 60 frames a second as high in a second. */
const FLIGHT = 1 / 60

/** Frames after which a picture that is not full has failed. */
const MOST_FRAMES = 2000

/** Cost of terrain in a view. */
export interface TerrainCost {
  name: string
  resolution: number
  /** A frame with sky, haze, sun and light of the sky, GPU, without a shadow map [ms]. */
  ms: number
  /** A frame without the terrain, GPU [ms]. */
  withoutMs: number
  /** A frame with a shadow map of 2048 texels, GPU [ms]. */
  shadowMs: number
  /** Drawing pages while flying, GPU: the mean of a frame, and the most [ms]. */
  pagesMs: number
  pagesMostMs: number
  /** CPU time of a frame in flight, of the terrain alone: choosing tiles and asking for pages [ms]. */
  updateMs: number
  /** Time from a new terrain to a full picture, frame after frame: wall-clock [ms], and in frames. */
  firstMs: number
  firstFrames: number
  tiles: number
  pages: number
  bytes: number
}

/** The quick start's scene. */
class TerrainBench {
  readonly #atmosphere = new Atmosphere({ frame: 'ecef' })
  readonly #camera: PerspectiveCamera
  readonly #scene = new Scene()
  readonly #sun = new SunDirectionalLight(this.#atmosphere)
  readonly #target: RenderTarget
  readonly #axes = new Matrix4()
  terrain: Terrain | null = null

  constructor(
    readonly renderer: WebGPURenderer,
    [width, height]: readonly [number, number]
  ) {
    this.#camera = new PerspectiveCamera(60, width / height, 0.2, 1e8)
    this.#target = new RenderTarget(width, height)
    const sky = new SkyLightProbe(this.#atmosphere)
    this.#scene.add(this.#sun, this.#sun.target, sky)
    this.#scene.backgroundNode = skyBackground(this.#atmosphere)
    this.#scene.fogNode = aerialPerspectiveFog(this.#atmosphere)
    const { left, right } = this.#sun.shadow.camera
    if (left >= right) throw new Error('bench: the shadow camera has no width')
    Object.assign(this.#sun.shadow.camera, { left: -200, right: 200, top: 200, bottom: -200 })
    Object.assign(this.#sun.shadow.camera, { near: 1, far: 2000 })
    this.#sun.shadow.mapSize.set(2048, 2048)
    renderer.shadowMap.enabled = true
  }

  add(resolution: number): Terrain {
    const heights = new MountainHeights({ seed: 513 })
    this.terrain = new Terrain(this.#atmosphere, heights, { resolution })
    this.#scene.add(this.terrain)
    return this.terrain
  }

  /** Plants the whole sample of vegetation. */
  plant(): Vegetation {
    const plants = new Vegetation(this.renderer, this.terrain!)
    this.#scene.add(plants)
    plants.update(this.#camera, 0, Infinity)
    return plants
  }

  look(view: (typeof VIEWS)[number] | typeof MEADOW, way = 0): void {
    const { height, pitch } = view
    const { ellipsoid } = this.#atmosphere
    const { longitude, latitude } = 'longitude' in view ? view : PLACE
    const place = { longitude, latitude: latitude + (way * height) / 111_000 }
    const ground = this.terrain?.heightAt(place.longitude, place.latitude) ?? 0
    const camera = this.#camera
    ellipsoid.geodeticToECEF({ ...place, height: ground + height }, camera.position)
    camera.quaternion.setFromRotationMatrix(ellipsoid.localYUpFrame(camera.position, this.#axes))
    const up = ellipsoid.surfaceNormal(camera.position)
    camera.rotateX((pitch * Math.PI) / 180)
    camera.near = Math.min(height / 10, 1e4)
    camera.updateProjectionMatrix()
    camera.updateMatrixWorld()
    this.#atmosphere.sunDirection = up.clone().addScaledVector(up.clone().cross(camera.up), 1)
    this.#sun.target.position.copy(camera.position)
    this.#sun.target.updateMatrixWorld()
  }

  set castsShadow(castsShadow: boolean) {
    this.#sun.castShadow = castsShadow
    if (this.terrain) this.terrain.castShadow = this.terrain.receiveShadow = castsShadow
  }

  draw(): void {
    nextFrame()
    this.renderer.setRenderTarget(this.#target)
    this.renderer.render(this.#scene, this.#camera)
    this.renderer.setRenderTarget(null)
  }

  /** Median GPU time of frames [ms]. */
  async time(frames: number, before: (frame: number) => void = () => undefined): Promise<number[]> {
    const times: number[] = []
    for (let frame = 0; frame < WARM_UP + frames; frame++) {
      before(frame)
      this.draw()
      const ms = await gpuMilliseconds(this.renderer)
      if (frame >= WARM_UP) times.push(ms)
    }
    return times
  }

  /** CPU time of choosing tiles [ms]. */
  update(): number {
    const start = performance.now()
    this.terrain!.update(this.renderer, this.#camera, 0)
    return performance.now() - start
  }

  dispose(): void {
    this.terrain?.dispose()
    this.#atmosphere.dispose()
    this.#target.dispose()
  }
}

/** Times the procedural planet from one height. */
async function timeView(
  renderer: WebGPURenderer,
  size: readonly [number, number],
  frames: number,
  view: (typeof VIEWS)[number],
  resolution: number
): Promise<TerrainCost> {
  const bench = new TerrainBench(renderer, size)
  bench.look(view)
  bench.castsShadow = false
  const withoutMs = median(await bench.time(frames))
  const terrain = bench.add(resolution)
  bench.castsShadow = false
  bench.look(view)
  const start = performance.now()
  let firstFrames = 0
  for (; !terrain.isFull && firstFrames < MOST_FRAMES; firstFrames++) {
    bench.draw()
    await finished(renderer)
  }
  const firstMs = performance.now() - start
  if (!terrain.isFull) throw new Error(`bench: no full picture from ${view.name}`)
  const ms = median(await bench.time(frames))
  const updates: number[] = []
  const moving = await bench.time(frames, frame => {
    bench.look(view, frame * FLIGHT)
    updates.push(bench.update())
  })
  bench.castsShadow = true
  const shadowMs = median(await bench.time(frames))
  const { count: pages, bytes } = terrain.pages
  const { inView: tiles } = terrain.tileCount
  bench.dispose()
  return {
    name: view.name,
    resolution,
    ms,
    withoutMs,
    shadowMs,
    pagesMs: moving.reduce((sum, value) => sum + value, 0) / moving.length - ms,
    pagesMostMs: Math.max(...moving) - ms,
    updateMs: median(updates),
    firstMs,
    firstFrames,
    tiles,
    pages,
    bytes
  }
}

/** Times the terrain from all heights. */
export async function timeTerrain(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number,
  resolutions: readonly number[] = [12]
): Promise<TerrainCost[]> {
  const costs: TerrainCost[] = []
  for (const resolution of resolutions) {
    for (const view of VIEWS) {
      const renderer = await device.renderer(...size, { reversedDepthBuffer: true })
      renderer.highPrecision = true
      costs.push(await timeView(renderer, size, frames, view, resolution))
      release(renderer)
    }
  }
  return costs
}

/** Line of a report. */
export function terrainLine(cost: TerrainCost): string {
  const { name, resolution, tiles, pages, bytes, firstFrames } = cost
  const ms = (value: number): string => `${value.toFixed(2)} ms`
  return (
    `terrain, ${name.padEnd(10)} resolution ${resolution}   ${ms(cost.ms)}, without it ${ms(cost.withoutMs)}` +
    `, with a shadow map ${ms(cost.shadowMs)}   pages in flight ${ms(cost.pagesMs)}, at most ${ms(cost.pagesMostMs)}` +
    `   CPU ${ms(cost.updateMs)}   first picture ${cost.firstMs.toFixed(0)} ms, ${firstFrames} frames` +
    `   ${tiles} tiles in view, ${pages} pages, ${(bytes / 1e6).toFixed(0)} MB`
  )
}

/** Cost of the stories' sample of vegetation, at eye height in a clearing. */
export interface VegetationCost {
  /** A frame without and with it, GPU, no shadow map [ms]. */
  withoutMs: number
  ms: number
  /** Frames without and with it, with a shadow map of 2048 texels [ms]. */
  withoutShadowMs: number
  shadowMs: number
  /** Time of planting all that is in view, CPU [ms]. */
  plantMs: number
}

/** Times grass, flowers and trees of the stories. */
export async function timeVegetation(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number
): Promise<VegetationCost> {
  const renderer = await device.renderer(...size, { reversedDepthBuffer: true })
  renderer.highPrecision = true
  const bench = new TerrainBench(renderer, size)
  const terrain = bench.add(12)
  bench.look(MEADOW)
  for (let i = 0; !terrain.isFull && i < MOST_FRAMES; i++) {
    bench.draw()
    await finished(renderer)
  }
  const both = async (): Promise<[number, number]> => {
    bench.castsShadow = false
    const without = median(await bench.time(frames))
    bench.castsShadow = true
    return [without, median(await bench.time(frames))]
  }
  const [withoutMs, withoutShadowMs] = await both()
  const start = performance.now()
  const plants = bench.plant()
  const plantMs = performance.now() - start
  const [ms, shadowMs] = await both()
  plants.dispose()
  bench.dispose()
  release(renderer)
  return { withoutMs, ms, withoutShadowMs, shadowMs, plantMs }
}

/** Line of a report. */
export function vegetationLine(cost: VegetationCost): string {
  const ms = (value: number): string => `${value.toFixed(2)} ms`
  return (
    `vegetation, in a meadow   ${ms(cost.ms)}, without it ${ms(cost.withoutMs)}, with a shadow map ${ms(cost.shadowMs)}` +
    `, without it ${ms(cost.withoutShadowMs)}   planting ${cost.plantMs.toFixed(0)} ms`
  )
}
