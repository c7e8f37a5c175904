import { Atmosphere } from '@welkin/atmosphere'
import { MountainHeights, Terrain } from '@welkin/terrain'
import { Matrix4, NearestFilter, PerspectiveCamera, RenderTarget, Scene, Vector3 } from 'three'
import { vec4 } from 'three/tsl'
import type { WebGPURenderer } from 'three/webgpu'
import { randomSequence } from '../../stories/src/random'
import { nextFrame, release, type HeadlessDevice } from '../headless/device'

/** Size of a camera's picture, and cameras along a row and a column of those that are read together. */
const WIDTH = 64
const HEIGHT = 36
const SIDE = 10

/** Cameras about a place: pages are shared by them. */
const PER_PLACE = 20

/** Every fourth place has pages missing, so many of which are drawn for a camera. */
const HASTY = 4
const FEW_PAGES = 6

/** A place where no ground was drawn. */
export interface Crack {
  readonly longitude: number
  readonly latitude: number
  readonly height: number
  readonly pixels: number
}

/** Result of a search. */
export interface CrackSearch {
  readonly cameras: number
  readonly pixels: number
  readonly seconds: number
  readonly cracks: Crack[]
}

/** A camera whose picture is not read yet. */
interface Shot {
  readonly camera: PerspectiveCamera
  readonly place: Omit<Crack, 'pixels'>
}

const degrees = (radians: number): number => (radians * 180) / Math.PI

/** Places where cracks are likeliest: poles, the antimeridian, edges and corners of the cube; the others are anywhere. */
const SPECIAL = [
  [10, 90],
  [0, -90],
  [180, 12],
  [-180, -50],
  [45, 0],
  [45, 35.2644],
  [-135, -35.2644],
  [0, 45]
] as const

/** Draws the ground from cameras anywhere, and looks for pixels below the horizon that have none. */
class CrackHunt {
  readonly #atmosphere = new Atmosphere({ frame: 'ecef' })
  readonly #heights = new MountainHeights({ seed: 513 })
  readonly #terrain: Terrain
  readonly #scene = new Scene()
  readonly #target = new RenderTarget(SIDE * WIDTH, SIDE * HEIGHT, {
    minFilter: NearestFilter,
    magFilter: NearestFilter
  })
  readonly #shots: Shot[] = []
  readonly #axes = new Matrix4()
  readonly #random = randomSequence(31)
  readonly cracks: Crack[] = []
  cameras = 0
  pixels = 0

  constructor(readonly renderer: WebGPURenderer) {
    this.#terrain = new Terrain(this.#atmosphere, this.#heights, {
      seaLevel: -Infinity,
      pageMemory: 60
    })
    this.#terrain.material.fragmentNode = vec4(0, 1, 0, 1)
    renderer.setClearColor(0, 0)
    this.#scene.add(this.#terrain)
    this.#target.scissorTest = true
  }

  /** Takes the pictures of a place. */
  async visit(number: number): Promise<void> {
    const random = this.#random
    const special = SPECIAL[number % (4 * SPECIAL.length)]
    const longitude = special?.[0] ?? 360 * random() - 180
    const latitude = special?.[1] ?? degrees(Math.asin(2 * random() - 1))
    const isHasty = number % HASTY === HASTY - 1
    for (let i = 0; i < PER_PLACE; i++) {
      const height = 2 * 1e7 ** random()
      const aside = Math.min((2 * height) / 111_000, 5)
      const place = {
        longitude: longitude + aside * (random() - 0.5),
        latitude: Math.min(Math.max(latitude + aside * (random() - 0.5), -90), 90),
        height
      }
      this.#shoot({ camera: this.#cameraAt(place), place }, isHasty ? FEW_PAGES : Infinity)
      if (this.#shots.length === SIDE * SIDE) await this.read()
    }
  }

  #cameraAt({ longitude, latitude, height }: Shot['place']): PerspectiveCamera {
    const random = this.#random
    const { ellipsoid } = this.#atmosphere
    const camera = new PerspectiveCamera(20 + 70 * random(), WIDTH / HEIGHT, height / 20, 1e9)
    const ground = this.#terrain.heightAt(longitude, latitude)
    ellipsoid.geodeticToECEF({ longitude, latitude, height: ground + height }, camera.position)
    camera.quaternion.setFromRotationMatrix(ellipsoid.localYUpFrame(camera.position, this.#axes))
    camera.rotateY(2 * Math.PI * random())
    camera.rotateX(-0.5 * Math.PI * random())
    camera.rotateZ(random() - 0.5)
    camera.coordinateSystem = this.renderer.coordinateSystem
    camera.updateProjectionMatrix()
    camera.updateMatrixWorld()
    return camera
  }

  #shoot(shot: Shot, pages: number): void {
    const { renderer } = this
    const n = this.#shots.push(shot) - 1
    nextFrame()
    this.#terrain.update(renderer, shot.camera, pages)
    const [x, y] = [(n % SIDE) * WIDTH, Math.floor(n / SIDE) * HEIGHT]
    this.#target.viewport.set(x, y, WIDTH, HEIGHT)
    this.#target.scissor.set(x, y, WIDTH, HEIGHT)
    renderer.autoClear = n === 0
    renderer.setRenderTarget(this.#target)
    if (n > 0) renderer.clearDepth()
    renderer.render(this.#scene, shot.camera)
    renderer.setRenderTarget(null)
  }

  /** Reads the pictures that were drawn. */
  async read(): Promise<void> {
    const { width, height } = this.#target
    const data = (await this.renderer.readRenderTargetPixelsAsync(
      this.#target,
      0,
      0,
      width,
      height
    )) as Uint8Array
    const stride = data.length / height / 4
    const core = this.#atmosphere.ellipsoid.grown(this.#heights.lowest)
    const ray = new Vector3()
    for (const [n, { camera, place }] of this.#shots.entries()) {
      const [left, top] = [(n % SIDE) * WIDTH, Math.floor(n / SIDE) * HEIGHT]
      let pixels = 0
      for (let y = 0; y < HEIGHT; y++) {
        for (let x = 0; x < WIDTH; x++) {
          ray.set((2 * x + 1) / WIDTH - 1, 1 - (2 * y + 1) / HEIGHT, 0.5)
          ray.unproject(camera).sub(camera.position)
          if (!(core.intersectRayDistance(camera.position, ray)! > 0)) continue
          this.pixels++
          if (data[4 * ((top + y) * stride + left + x) + 1] === 0) pixels++
        }
      }
      this.cameras++
      if (pixels > 0) this.cracks.push({ ...place, pixels })
    }
    this.#shots.length = 0
  }

  dispose(): void {
    this.#terrain.dispose()
    this.#target.dispose()
    this.#atmosphere.dispose()
  }
}

/**
 * Looks for cracks from random cameras.
 *
 * @param count - Number of cameras, a multiple of 20.
 * @param most - Time after which it ends [s].
 */
export async function findCracks(
  device: HeadlessDevice,
  count: number,
  most: number
): Promise<CrackSearch> {
  const renderer = await device.renderer(SIDE * WIDTH, SIDE * HEIGHT, { reversedDepthBuffer: true })
  renderer.highPrecision = true
  const hunt = new CrackHunt(renderer)
  const start = performance.now()
  const seconds = (): number => (performance.now() - start) / 1000
  for (let n = 0; n < count / PER_PLACE && seconds() < most; n++) await hunt.visit(n)
  await hunt.read()
  const { cameras, pixels, cracks } = hunt
  const result = { cameras, pixels, seconds: seconds(), cracks }
  hunt.dispose()
  release(renderer)
  return result
}

/** Lines of a report. */
export function crackLines({ cameras, pixels, seconds, cracks }: CrackSearch): string {
  const found = cracks.map(
    ({ longitude, latitude, height, pixels: missing }) =>
      `  ${missing} pixels from ${longitude}°, ${latitude}°, ${height.toPrecision(6)} m`
  )
  return [
    `cracks         ${cracks.length} of ${cameras} cameras, ${(pixels / 1e6).toFixed(1)} million pixels below the horizon, ${seconds.toFixed(0)} s`,
    ...found.slice(0, 20)
  ].join('\n')
}
