import { Vegetation } from '../../stories/src/terrain/vegetation/Vegetation'
import type { HeadlessDevice } from '../headless/device'
import { median } from './statistics'
import { PLACE, TerrainBench, VIEWS, type TerrainView } from './TerrainBench'

/** A clearing in woods, for the sample of vegetation. */
const MEADOW = { name: 'meadow', height: 2, pitch: -4, longitude: 0.494, latitude: 46.35 } as const

/** Way flown in a frame, in heights above the ground: at 60 frames a second as high in a second. */
const FLIGHT = 1 / 60

/** Way flown in a frame at least [m]: at eye height no page is due for metres. */
const LEAST_WAY = 0.5

/** Choices of tiles that are timed: the first hundred, before the engine has compiled them, take twice as long. */
const UPDATES = 400

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

/** Times the procedural planet from one height. */
async function timeView(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number,
  view: TerrainView,
  resolution: number
): Promise<TerrainCost> {
  const bench = await TerrainBench.open(device, size)
  bench.look(view)
  bench.castsShadow = false
  const withoutMs = median(await bench.time(frames))
  const terrain = bench.add(undefined, { resolution })
  bench.castsShadow = false
  bench.look(view)
  const start = performance.now()
  const firstFrames = await bench.fill()
  const firstMs = performance.now() - start
  const ms = median(await bench.time(frames))
  const way = Math.max(FLIGHT * view.height, LEAST_WAY)
  const fly = (frame: number): void =>
    bench.look({
      ...view,
      latitude: PLACE.latitude + (frame * way) / 111_000
    })
  const moving = await bench.time(frames, fly)
  const updates = Array.from({ length: UPDATES }, (_, i) => {
    fly(i % frames)
    return bench.update()
  })
  const { count: pages, bytes } = terrain.pages
  const { inView: tiles } = terrain.tileCount
  bench.castsShadow = true
  // Ground out of view that casts shadows has pages, too.
  bench.draw()
  await bench.fill()
  const shadowMs = median(await bench.time(frames))
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
      costs.push(await timeView(device, size, frames, view, resolution))
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
  const bench = await TerrainBench.open(device, size)
  const terrain = bench.add()
  bench.look(MEADOW)
  await bench.fill()
  const both = async (): Promise<[number, number]> => {
    bench.castsShadow = false
    const without = median(await bench.time(frames))
    bench.castsShadow = true
    return [without, median(await bench.time(frames))]
  }
  const [withoutMs, withoutShadowMs] = await both()
  const start = performance.now()
  const plants = new Vegetation(bench.renderer, terrain)
  bench.scene.add(plants)
  plants.update(bench.camera, 0, Infinity)
  const plantMs = performance.now() - start
  const [ms, shadowMs] = await both()
  plants.dispose()
  bench.dispose()
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
