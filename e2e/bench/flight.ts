import {
  GridHeights,
  MountainHeights,
  TerrariumTiles,
  type HeightSource,
  type PageSource
} from '@welkin/terrain'
import { MathUtils } from 'three'
import { setFlagsFromString } from 'node:v8'
import { runInNewContext } from 'node:vm'
import { randomNumbers } from '../../packages/terrain/test/randomNumbers'
import { finished, type HeadlessDevice } from '../headless/device'
import { bytesOf, watchTextures } from './memory'
import { TerrainBench, VIEWS } from './TerrainBench'

/** Side of the local grid [cells], and of a tile [pixels]. */
const GRID = 1024
const TILE = 256

/** A flight of half an hour [s], how long a frame of it is [s], and times that memory is measured at. */
const FLIGHT = 1800
const STEP = 0.2
const MEASURED = 6

/** Frames between two turns of the flight. */
const LEG = 150

/** Hills between 100 and 900 m, at a place [radians or any]. */
const hills = (x: number, y: number): number =>
  500 + 250 * Math.sin(x) + 100 * Math.sin(3.1 * y) + 50 * Math.sin(7 * (x + y))

/** Time that pixels of tiles have taken to be made, which is none of the terrain's [ms]. */
let pixelsMs = 0

/** Sources whose data is at hand: a function, a grid in memory, and tiles that are loaded from memory. */
export const sources: Record<string, () => HeightSource | PageSource> = {
  function: () => new MountainHeights({ seed: 513 }),
  grid: () =>
    new GridHeights(
      Float32Array.from({ length: GRID ** 2 }, (_, i) =>
        hills((i % GRID) / 20, Math.floor(i / GRID) / 20)
      ),
      { width: GRID, height: GRID, west: 0.8, east: 1.2, south: 46.85, north: 47.15, outside: 500 }
    ),
  tiles: () =>
    new TerrariumTiles('memory:{z}/{x}/{y}', {
      maxZoom: 12,
      loadPixels: url => {
        const start = performance.now()
        const [z, x, y] = url
          .slice(url.indexOf(':') + 1)
          .split('/')
          .map(Number)
        const data = new Uint8ClampedArray(4 * TILE ** 2)
        // Tables of sines: what is timed is no drawing of pixels.
        const angle = (300 * 2 * Math.PI) / 2 ** z
        const waves = (first: number, wave: (angle: number) => number): Float32Array =>
          Float32Array.from({ length: TILE }, (_, i) => wave(angle * (first + i / TILE)))
        const along = waves(x, a => 500 + 250 * Math.sin(a))
        const down = waves(y, a => 100 * Math.sin(3.1 * a))
        for (let i = 0; i < TILE ** 2; i++) {
          const value = 32_768 + along[i % TILE] + down[Math.floor(i / TILE)]
          data[4 * i] = value / 256
          data[4 * i + 1] = value % 256
          data[4 * i + 2] = (value % 1) * 256
          data[4 * i + 3] = 255
        }
        pixelsMs += performance.now() - start
        return Promise.resolve({ width: TILE, height: TILE, data })
      }
    })
}

/** Time until a picture is full. */
export interface FirstPicture {
  source: string
  /** Wall-clock time from a new terrain on, frame after frame [ms]. */
  ms: number
  /** Part of it in which the bench made pixels of tiles [ms]. */
  pixelsMs: number
  frames: number
}

/** Memory in flight. */
export interface FlightMemory {
  minutes: number
  frames: number
  pages: number
  /** Terrain's textures on the GPU, and all textures that are alive [bytes]. */
  terrainBytes: number
  textures: number
  /** Geometries of the renderer. */
  geometries: number
  /** JavaScript's heap after its collection [bytes]. */
  heapBytes: number
}

/** Times the first full picture at eye height from sources whose data is at hand, atmosphere and shaders included. */
export async function timeFirstPictures(
  device: HeadlessDevice,
  size: readonly [number, number]
): Promise<FirstPicture[]> {
  const pictures: FirstPicture[] = []
  for (const [source, make] of Object.entries(sources)) {
    const heights = make()
    const bench = await TerrainBench.open(device, size)
    bench.castsShadow = false
    pixelsMs = 0
    const start = performance.now()
    bench.add(heights)
    bench.look(VIEWS[0])
    const frames = await bench.fill()
    pictures.push({ source, ms: performance.now() - start, pixelsMs, frames })
    bench.dispose()
  }
  return pictures
}

/** Bytes of JavaScript's heap that are in use after a collection. */
function heapBytes(): number {
  setFlagsFromString('--expose-gc')
  ;(runInNewContext('gc') as () => void)()
  return process.memoryUsage().heapUsed
}

/**
 * Flies anywhere, from 2 m to 20,000 km high, for half an hour, and measures memory on the way.
 *
 * @param report - Called with each measurement, as it is made.
 */
export async function measureFlight(
  device: HeadlessDevice,
  report: (memory: FlightMemory) => void
): Promise<FlightMemory[]> {
  const bench = await TerrainBench.open(device, [128, 72])
  const { renderer } = bench
  const alive = watchTextures((renderer.backend as unknown as { device: GPUDevice }).device)
  bench.castsShadow = false
  bench.add(sources.function())
  const random = randomNumbers(7)
  const frames = FLIGHT / STEP
  const measured: FlightMemory[] = []
  let [longitude, latitude, power, climb, speed, heading, pitch] = [0, 0, 3, 0, 0, 0, 0]
  for (let frame = 0; frame <= frames; frame++) {
    if (frame % LEG === 0) {
      climb = (0.3 + 7 * random() - power) / LEG
      speed = 2 * random() ** 3
      ;[heading, pitch] = [7 * random(), -1.5 * random()]
      // A leap to anywhere.
      if (random() < 0.2) [longitude, latitude] = [360 * random() - 180, 160 * random() - 80]
    }
    power = Math.min(Math.max(power + climb, 0.3), 7.3)
    const way = Math.min((speed * STEP * 10 ** power) / 111_000, 5)
    longitude = ((longitude - way * Math.sin(heading) + 540) % 360) - 180
    latitude = Math.min(Math.max(latitude + way * Math.cos(heading), -85), 85)
    bench.look({
      name: 'flight',
      longitude,
      latitude,
      height: 10 ** power,
      heading: MathUtils.radToDeg(heading),
      pitch: MathUtils.radToDeg(pitch)
    })
    bench.draw()
    if (frame % 64 === 0) await finished(renderer)
    if (frame % (frames / MEASURED) !== 0) continue
    const ofTerrain = [...alive].filter(({ label }) => label.startsWith('Welkin.Terrain'))
    const memory = {
      minutes: (frame * STEP) / 60,
      frames: frame,
      pages: bench.terrain.pages.count,
      terrainBytes: ofTerrain.reduce((sum, texture) => sum + bytesOf(texture), 0),
      textures: alive.size,
      geometries: renderer.info.memory.geometries,
      heapBytes: heapBytes()
    }
    measured.push(memory)
    report(memory)
  }
  bench.dispose()
  return measured
}

/** Lines of a report. */
export const firstPictureLines = (pictures: FirstPicture[]): string =>
  pictures
    .map(
      ({ source, ms, pixelsMs, frames }) =>
        `first full picture, ${source.padEnd(8)}   ${ms.toFixed(0)} ms, ${frames} frames` +
        (pixelsMs > 0 ? `, of which the bench's own tiles ${pixelsMs.toFixed(0)} ms` : '')
    )
    .join('\n')

/** Line of a report. */
export function flightLine(memory: FlightMemory): string {
  const { minutes, pages, terrainBytes, textures, geometries, heapBytes } = memory
  const megabytes = (bytes: number): string => `${(bytes / 1e6).toFixed(1)} MB`
  return (
    `in flight, ${String(minutes).padStart(2)} min   ${pages} pages   ${megabytes(terrainBytes)} of ${textures} textures` +
    `   ${geometries} geometries   heap ${megabytes(heapBytes)}`
  )
}
