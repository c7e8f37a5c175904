import { Atmosphere } from '@welkin/atmosphere'
import { MountainHeights, Terrain, type HeightSource } from '@welkin/terrain'
import { Matrix4, NearestFilter, PerspectiveCamera, RenderTarget, Scene, Vector3 } from 'three'
import { vec4 } from 'three/tsl'
import type { WebGPURenderer } from 'three/webgpu'
import { randomSequence } from '../../stories/src/random'
import { nextFrame, release, type HeadlessDevice } from '../headless/device'
import { WaveHeights } from './cracksGround'

/** Size of a camera's picture, and cameras along a row and a column of those that are read together. */
const WIDTH = 64
const HEIGHT = 36
const SIDE = 10

/** Cameras about a place: pages are shared by them. */
const PER_PLACE = 20

/** Every fifth place has pages missing, so many of which are drawn for a camera: no divisor of the special places' turn, so that they have them all once. */
const HASTY = 5
const FEW_PAGES = 6

/**
 * Longest edge of a triangle over its distance: a tile is no nearer than 1.2 of its diagonals, which are twelve cells long. Where pages
 * are missing it may be longer; no more than so from afar, where it counts.
 */
const LONGEST_EDGE = 1 / 14.4
const LONGEST_HASTY = 4 / 14.4

/** Pages drawn for a camera over the procedural planet, each of which costs as much as the camera's picture. */
const COSTLY_PAGES = 24

/** Cameras between two lines of progress. */
const REPORTED = 1000

/** A place where no ground was drawn. */
export interface Crack {
  readonly ground: GroundName
  readonly longitude: number
  readonly latitude: number
  readonly height: number
  readonly pixels: number
  /** First of them, column and row. */
  readonly first: readonly [number, number]
  /** Camera: vertical field of view [°] and quaternion; and whether all pages were there. */
  readonly fov: number
  readonly rotation: readonly number[]
  readonly isFull: boolean
}

/** Result of a search. */
export interface CrackSearch {
  readonly cameras: number
  readonly pixels: number
  readonly seconds: number
  readonly cracks: Crack[]
  /** Cameras with such pixels at the limb alone, where a globe of triangles is lower than a smooth one. */
  readonly atLimb: number
}

/** Ground that is looked at: rough waves, or the procedural planet. */
type GroundName = 'waves' | 'mountains'

/** A camera whose picture is not read yet. */
interface Shot {
  readonly camera: PerspectiveCamera
  readonly place: Pick<Crack, 'longitude' | 'latitude' | 'height'>
  /** Longest edge of a triangle over its distance. */
  edge: number
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
  readonly #heights: HeightSource
  readonly #terrain: Terrain
  readonly #scene = new Scene()
  /** One is drawn to while the other is read. */
  readonly #targets = [0, 1].map(
    () =>
      new RenderTarget(SIDE * WIDTH, SIDE * HEIGHT, {
        minFilter: NearestFilter,
        magFilter: NearestFilter
      })
  )
  #shots: Shot[] = []
  #reading: Promise<void> = Promise.resolve()
  readonly #axes = new Matrix4()
  readonly #random = randomSequence(31)
  readonly cracks: Crack[] = []
  cameras = 0
  atLimb = 0
  pixels = 0

  constructor(
    readonly renderer: WebGPURenderer,
    readonly ground: GroundName
  ) {
    this.#heights = ground === 'waves' ? new WaveHeights() : new MountainHeights({ seed: 513 })
    this.#terrain = new Terrain(this.#atmosphere, this.#heights, {
      seaLevel: -Infinity,
      // As much as one camera sees: slopes of pages have few texels then, and nobody looks at them.
      pageMemory: 20
    })
    this.#terrain.material.fragmentNode = vec4(0, 1, 0, 1)
    renderer.setClearColor(0, 0)
    this.#scene.add(this.#terrain)
    for (const target of this.#targets) target.scissorTest = true
  }

  /** Pages drawn so far. */
  get pages(): number {
    return this.#terrain.pages.drawn
  }

  /** Takes the pictures of a place, from the highest one down: what a camera saw is there for the next. */
  async visit(number: number): Promise<void> {
    const random = this.#random
    const special = SPECIAL[number % (4 * SPECIAL.length)]
    const longitude = special?.[0] ?? 360 * random() - 180
    const latitude = special?.[1] ?? degrees(Math.asin(2 * random() - 1))
    const most = this.ground === 'waves' ? Infinity : COSTLY_PAGES
    const pages = number % HASTY === HASTY - 1 ? FEW_PAGES : most
    const heights = Array.from({ length: PER_PLACE }, () => 2 * 1e7 ** random())
    for (const height of heights.sort((a, b) => b - a)) {
      const aside = Math.min((2 * height) / 111_000, 5)
      const place = {
        longitude: longitude + aside * (random() - 0.5),
        latitude: Math.min(Math.max(latitude + aside * (random() - 0.5), -90), 90),
        height
      }
      this.#shoot({ camera: this.#cameraAt(place), place, edge: LONGEST_EDGE }, pages)
      if (this.#shots.length === SIDE * SIDE) await this.#read()
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
    const [target] = this.#targets
    const n = this.#shots.push(shot) - 1
    nextFrame()
    this.#terrain.update(renderer, shot.camera, pages)
    if (!this.#terrain.isFull) shot.edge = LONGEST_HASTY
    const [x, y] = [(n % SIDE) * WIDTH, Math.floor(n / SIDE) * HEIGHT]
    target.viewport.set(x, y, WIDTH, HEIGHT)
    target.scissor.set(x, y, WIDTH, HEIGHT)
    renderer.autoClear = n === 0
    renderer.setRenderTarget(target)
    if (n > 0) renderer.clearDepth()
    renderer.render(this.#scene, shot.camera)
    renderer.setRenderTarget(null)
  }

  /** Asks for the pictures that were drawn, once those before have come. */
  async #read(): Promise<void> {
    await this.#reading
    const [target] = this.#targets
    const shots = this.#shots
    this.#shots = []
    const { width, height } = target
    this.#reading = this.renderer
      .readRenderTargetPixelsAsync(target, 0, 0, width, height)
      .then(data => this.#count(shots, data as Uint8Array))
    this.#targets.reverse()
  }

  /** Reads what is left. */
  async finish(): Promise<void> {
    await this.#read()
    await this.#reading
  }

  #count(shots: readonly Shot[], data: Uint8Array): void {
    const stride = data.length / (SIDE * HEIGHT) / 4
    const { radii } = this.#atmosphere.ellipsoid.grown(this.#heights.lowest)
    const [right, up, forward, ray] = [0, 1, 2, 3].map(() => new Vector3())
    for (const [n, { camera, place, edge }] of shots.entries()) {
      const [left, top] = [(n % SIDE) * WIDTH, Math.floor(n / SIDE) * HEIGHT]
      // Where the lowest ground is the unit sphere.
      camera.matrixWorld.extractBasis(right, up, forward)
      const tangent = Math.tan((camera.fov * Math.PI) / 360)
      right.multiplyScalar(tangent * camera.aspect).divide(radii)
      up.multiplyScalar(tangent).divide(radii)
      forward.divide(radii)
      const position = camera.position.clone().divide(radii)
      // The horizon of a globe of triangles lies deeper, by their sagitta.
      const sagitta = (edge * edge * (position.lengthSq() - 1)) / 8
      const over = position.lengthSq() - 1
      const surelyOver = position.lengthSq() - (1 - sagitta) ** 2
      let [pixels, limb] = [0, 0]
      let first: [number, number] = [0, 0]
      for (let y = 0; y < HEIGHT; y++) {
        for (let x = 0; x < WIDTH; x++) {
          ray.copy(forward).negate()
          ray.addScaledVector(right, (2 * x + 1) / WIDTH - 1)
          ray.addScaledVector(up, 1 - (2 * y + 1) / HEIGHT)
          const down = -ray.dot(position)
          if (down <= 0 || down * down <= ray.lengthSq() * over) continue
          this.pixels++
          if (data[4 * ((top + y) * stride + left + x) + 1] !== 0) continue
          if (down * down > ray.lengthSq() * surelyOver) {
            if (pixels === 0) first = [x, y]
            pixels++
          } else limb++
        }
      }
      this.cameras++
      if (limb > 0 && pixels === 0) this.atLimb++
      if (pixels > 0) {
        const [fov, rotation] = [camera.fov, camera.quaternion.toArray()]
        const isFull = edge === LONGEST_EDGE
        this.cracks.push({ ground: this.ground, ...place, pixels, first, fov, rotation, isFull })
      }
    }
  }

  dispose(): void {
    this.#terrain.dispose()
    for (const target of this.#targets) target.dispose()
    this.#atmosphere.dispose()
  }
}

/**
 * Looks for cracks from random cameras: the first half over the procedural planet, the others over rough waves.
 *
 * @param count - Number of cameras, a multiple of 200.
 * @param most - Time after which it ends [s].
 * @param report - Takes a line of progress.
 */
export async function findCracks(
  device: HeadlessDevice,
  count: number,
  most: number,
  report: (line: string) => void
): Promise<CrackSearch> {
  const start = performance.now()
  const seconds = (): number => (performance.now() - start) / 1000
  const sum = { cameras: 0, pixels: 0, atLimb: 0, cracks: [] as Crack[] }
  for (const [ground, part, until] of [
    ['mountains', 0.5, 0.5 * most],
    ['waves', 0.5, most]
  ] as const) {
    const renderer = await device.renderer(SIDE * WIDTH, SIDE * HEIGHT, {
      reversedDepthBuffer: true,
      trackTimestamp: false
    })
    renderer.highPrecision = true
    const hunt = new CrackHunt(renderer, ground)
    let reported = 0
    const places = Math.round((part * count) / PER_PLACE)
    for (let n = 0; n < places && seconds() < until; n++) {
      await hunt.visit(n)
      if (hunt.cameras < reported + REPORTED) continue
      reported = hunt.cameras
      report(
        `  ${ground}: ${reported} cameras, ${hunt.pages} pages, ${hunt.cracks.length} with gaps, ${seconds().toFixed(0)} s`
      )
    }
    await hunt.finish()
    sum.cameras += hunt.cameras
    sum.pixels += hunt.pixels
    sum.atLimb += hunt.atLimb
    sum.cracks.push(...hunt.cracks)
    hunt.dispose()
    release(renderer)
  }
  return { ...sum, seconds: seconds() }
}

/** Lines of a report. */
export function crackLines({ cameras, pixels, seconds, cracks, atLimb }: CrackSearch): string {
  const found = cracks.map(
    ({ ground, longitude, latitude, height, pixels: missing, ...shot }) =>
      `  ${ground}: ${missing} pixels from ${longitude}°, ${latitude}°, ${height} m, ${JSON.stringify(shot)}`
  )
  return [
    `cracks         ${cracks.length} of ${cameras} cameras, ${(pixels / 1e6).toFixed(1)} million pixels below the horizon, ${seconds.toFixed(0)} s; at the limb alone ${atLimb}`,
    ...found.slice(0, 20)
  ].join('\n')
}
