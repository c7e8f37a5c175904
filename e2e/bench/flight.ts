import { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import {
  GridHeights,
  MountainHeights,
  Terrain,
  TerrariumTiles,
  type HeightSource,
  type PageSource
} from '@welkin/terrain'
import { Matrix4, PerspectiveCamera, RenderTarget, Scene } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { setFlagsFromString } from 'node:v8'
import { runInNewContext } from 'node:vm'
import { randomNumbers } from '../../packages/terrain/test/randomNumbers'
import { finished, nextFrame, release, type HeadlessDevice } from '../headless/device'
import { bytesOf, watchTextures } from './memory'

const PLACE = { longitude: 1, latitude: 47 }

/** Side of the local grid [cells], and of a tile [pixels]. */
const GRID = 1024
const TILE = 256

/** Frames after which a picture that is not full has failed. */
const MOST_FRAMES = 5000

/** A flight of half an hour [s], how long a frame of it is [s], and times that memory is measured at. */
const FLIGHT = 1800
const STEP = 0.2
const MEASURED = 6

/** Frames between two turns of the flight. */
const LEG = 150

/** Hills between 100 and 900 m, at a place [radians or any]. */
const hills = (x: number, y: number): number =>
  500 + 250 * Math.sin(x) + 100 * Math.sin(3.1 * y) + 50 * Math.sin(7 * (x + y))

/** Sources whose data is at hand: a function, a grid in memory, and tiles that are loaded from memory. */
const sources: Record<string, () => HeightSource | PageSource> = {
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
        const [z, x, y] = url
          .slice(url.indexOf(':') + 1)
          .split('/')
          .map(Number)
        const data = new Uint8ClampedArray(4 * TILE ** 2)
        for (let i = 0; i < TILE ** 2; i++) {
          const along = (2 * Math.PI * (x + (i % TILE) / TILE)) / 2 ** z
          const down = (2 * Math.PI * (y + Math.floor(i / TILE) / TILE)) / 2 ** z
          const value = 32_768 + hills(300 * along, 300 * down)
          data.set([value / 256, value % 256, (value % 1) * 256, 255], 4 * i)
        }
        return Promise.resolve({ width: TILE, height: TILE, data })
      }
    })
}

/** Time until a picture is full. */
export interface FirstPicture {
  source: string
  /** Wall-clock time from a new terrain on, frame after frame [ms]. */
  ms: number
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

/** A terrain in the light of sun and sky. */
class FlightBench {
  readonly #atmosphere = new Atmosphere({ frame: 'ecef' })
  readonly #camera: PerspectiveCamera
  readonly #scene = new Scene()
  readonly #target: RenderTarget
  readonly #axes = new Matrix4()
  readonly terrain: Terrain

  constructor(
    readonly renderer: WebGPURenderer,
    [width, height]: readonly [number, number],
    source: HeightSource | PageSource
  ) {
    this.#camera = new PerspectiveCamera(60, width / height, 0.2, 1e8)
    this.#target = new RenderTarget(width, height)
    const sun = new SunDirectionalLight(this.#atmosphere)
    this.terrain = new Terrain(this.#atmosphere, source)
    this.#scene.add(sun, sun.target, new SkyLightProbe(this.#atmosphere), this.terrain)
    this.#atmosphere.date = new Date('2026-06-21T12:00:00Z')
  }

  look(longitude: number, latitude: number, height: number, heading: number, pitch: number): void {
    const { ellipsoid } = this.#atmosphere
    const camera = this.#camera
    const ground = this.terrain.heightAt(longitude, latitude)
    ellipsoid.geodeticToECEF({ longitude, latitude, height: ground + height }, camera.position)
    camera.quaternion.setFromRotationMatrix(ellipsoid.localYUpFrame(camera.position, this.#axes))
    camera.rotateY(heading)
    camera.rotateX(pitch)
    camera.near = Math.min(height / 10, 1e4)
    camera.updateProjectionMatrix()
    camera.updateMatrixWorld()
  }

  draw(): void {
    nextFrame()
    this.renderer.setRenderTarget(this.#target)
    this.renderer.render(this.#scene, this.#camera)
    this.renderer.setRenderTarget(null)
  }

  dispose(): void {
    this.terrain.dispose()
    this.#atmosphere.dispose()
    this.#target.dispose()
  }
}

/** Lets promises and timers of loaders run. */
const turn = (): Promise<void> => new Promise(resolve => setTimeout(resolve))

/** Times the first full picture at eye height from sources whose data is at hand, atmosphere and shaders included. */
export async function timeFirstPictures(
  device: HeadlessDevice,
  size: readonly [number, number]
): Promise<FirstPicture[]> {
  const pictures: FirstPicture[] = []
  for (const [source, make] of Object.entries(sources)) {
    const heights = make()
    const renderer = await device.renderer(...size, { reversedDepthBuffer: true })
    renderer.highPrecision = true
    const start = performance.now()
    const bench = new FlightBench(renderer, size, heights)
    let frames = 0
    for (; !bench.terrain.isFull && frames < MOST_FRAMES; frames++) {
      bench.look(PLACE.longitude, PLACE.latitude, 2, 0, -0.07)
      bench.draw()
      await finished(renderer)
      await turn()
    }
    if (!bench.terrain.isFull) throw new Error(`bench: no full picture of the source ${source}`)
    pictures.push({ source, ms: performance.now() - start, frames })
    bench.dispose()
    release(renderer)
  }
  return pictures
}

/** Bytes of JavaScript's heap that are in use after a collection. */
function heapBytes(): number {
  setFlagsFromString('--expose-gc')
  ;(runInNewContext('gc') as () => void)()
  return process.memoryUsage().heapUsed
}

/** Flies anywhere, from 2 m to 20,000 km high, for half an hour, and measures memory on the way. */
export async function measureFlight(device: HeadlessDevice): Promise<FlightMemory[]> {
  const size = [128, 72] as const
  const renderer = await device.renderer(...size, { reversedDepthBuffer: true })
  renderer.highPrecision = true
  const alive = watchTextures((renderer.backend as unknown as { device: GPUDevice }).device)
  const bench = new FlightBench(renderer, size, sources.function())
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
    bench.look(longitude, latitude, 10 ** power, heading, pitch)
    bench.draw()
    if (frame % 64 === 0) await finished(renderer)
    if (frame % (frames / MEASURED) !== 0) continue
    const ofTerrain = [...alive].filter(({ label }) => label.startsWith('Welkin.Terrain'))
    measured.push({
      minutes: (frame * STEP) / 60,
      frames: frame,
      pages: bench.terrain.pages.count,
      terrainBytes: ofTerrain.reduce((sum, texture) => sum + bytesOf(texture), 0),
      textures: alive.size,
      geometries: renderer.info.memory.geometries,
      heapBytes: heapBytes()
    })
  }
  bench.dispose()
  release(renderer)
  return measured
}

/** Lines of a report. */
export function flightLines(first: FirstPicture[], flight: FlightMemory[]): string {
  const megabytes = (bytes: number): string => `${(bytes / 1e6).toFixed(1)} MB`
  return [
    ...first.map(
      ({ source, ms, frames }) =>
        `first full picture, ${source.padEnd(8)}   ${ms.toFixed(0)} ms, ${frames} frames`
    ),
    ...flight.map(
      ({ minutes, pages, terrainBytes, textures, geometries, heapBytes }) =>
        `in flight, ${String(minutes).padStart(2)} min   ${pages} pages   ${megabytes(terrainBytes)} of ${textures} textures` +
        `   ${geometries} geometries   heap ${megabytes(heapBytes)}`
    )
  ].join('\n')
}
