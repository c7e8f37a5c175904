import {
  aerialPerspectiveFog,
  Atmosphere,
  skyBackground,
  SkyLightProbe,
  SunDirectionalLight
} from '@welkin/atmosphere'
import {
  MountainHeights,
  Terrain,
  type HeightSource,
  type PageSource,
  type TerrainOptions
} from '@welkin/terrain'
import { MathUtils, Matrix4, PerspectiveCamera, RenderTarget, Scene } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import {
  finished,
  gpuMilliseconds,
  nextFrame,
  release,
  type HeadlessDevice
} from '../headless/device'

/** Place where the ground is looked at [°]. */
export const PLACE = { longitude: 1, latitude: 47 }

/** Frames that are drawn before some are timed. */
const WARM_UP = 10

/** Frames after which a picture that is not full has failed. */
const MOST_FRAMES = 5000

/** Place and direction of a camera. */
export interface TerrainView {
  readonly name: string
  /** Over the ground [m]. */
  readonly height: number
  /** Over the horizon, and from north to west [°]. */
  readonly pitch: number
  readonly heading?: number
  /** Default: {@link PLACE} [°]. */
  readonly longitude?: number
  readonly latitude?: number
}

/** Heights from which the ground is measured, before a slope. */
export const VIEWS: readonly TerrainView[] = [
  { name: 'eye height', height: 2, pitch: -4 },
  { name: '1 km', height: 1e3, pitch: -10 },
  { name: '10 km', height: 1e4, pitch: -15 },
  { name: '400 km', height: 4e5, pitch: -30 }
]

/** The quick start's scene, with the sun 45° high in the south. */
export class TerrainBench {
  readonly camera: PerspectiveCamera
  readonly scene = new Scene()
  readonly #atmosphere = new Atmosphere({ frame: 'ecef' })
  readonly #sun = new SunDirectionalLight(this.#atmosphere)
  readonly #target: RenderTarget
  readonly #axes = new Matrix4()
  #terrain: Terrain | null = null

  private constructor(
    readonly renderer: WebGPURenderer,
    [width, height]: readonly [number, number]
  ) {
    this.camera = new PerspectiveCamera(60, width / height, 0.2, 1e8)
    this.#target = new RenderTarget(width, height)
    const { scene } = this
    scene.add(this.#sun, this.#sun.target, new SkyLightProbe(this.#atmosphere))
    scene.backgroundNode = skyBackground(this.#atmosphere)
    scene.fogNode = aerialPerspectiveFog(this.#atmosphere)
    const { left, right } = this.#sun.shadow.camera
    if (left >= right) throw new Error('bench: the shadow camera has no width')
    Object.assign(this.#sun.shadow.camera, { left: -200, right: 200, top: 200, bottom: -200 })
    Object.assign(this.#sun.shadow.camera, { near: 1, far: 2000 })
    this.#sun.shadow.mapSize.set(2048, 2048)
    renderer.shadowMap.enabled = true
  }

  /** The scene without ground, on a device of its own. */
  static async open(
    device: HeadlessDevice,
    size: readonly [number, number]
  ): Promise<TerrainBench> {
    const renderer = await device.renderer(...size, { reversedDepthBuffer: true })
    renderer.highPrecision = true
    return new TerrainBench(renderer, size)
  }

  /** Ground of the scene, once it has any. */
  get terrain(): Terrain {
    if (this.#terrain === null) throw new Error('bench: no terrain')
    return this.#terrain
  }

  add(
    source: HeightSource | PageSource = new MountainHeights({ seed: 513 }),
    options: TerrainOptions = {}
  ): Terrain {
    this.#terrain = new Terrain(this.#atmosphere, source, options)
    this.scene.add(this.#terrain)
    return this.#terrain
  }

  /** Moves the camera, and sun and shadow with it. */
  look({
    longitude = PLACE.longitude,
    latitude = PLACE.latitude,
    height,
    ...view
  }: TerrainView): void {
    const { ellipsoid } = this.#atmosphere
    const { camera } = this
    const ground = this.#terrain?.heightAt(longitude, latitude) ?? 0
    ellipsoid.geodeticToECEF({ longitude, latitude, height: ground + height }, camera.position)
    camera.quaternion.setFromRotationMatrix(ellipsoid.localYUpFrame(camera.position, this.#axes))
    camera.rotateY(MathUtils.degToRad(view.heading ?? 0))
    camera.rotateX(MathUtils.degToRad(view.pitch))
    camera.near = Math.min(height / 10, 1e4)
    camera.updateProjectionMatrix()
    camera.updateMatrixWorld()
    const up = ellipsoid.surfaceNormal(camera.position)
    this.#atmosphere.sunDirection = up.clone().addScaledVector(up.clone().cross(camera.up), 1)
    this.#sun.target.position.copy(camera.position)
    this.#sun.target.updateMatrixWorld()
  }

  set castsShadow(castsShadow: boolean) {
    this.#sun.castShadow = castsShadow
    if (this.#terrain) this.#terrain.castShadow = this.#terrain.receiveShadow = castsShadow
  }

  draw(): void {
    nextFrame()
    this.renderer.setRenderTarget(this.#target)
    this.renderer.render(this.scene, this.camera)
    this.renderer.setRenderTarget(null)
  }

  /**
   * Draws frame after frame until nothing is missing.
   *
   * @returns Frames that it took.
   */
  async fill(): Promise<number> {
    for (let frames = 0; frames < MOST_FRAMES; frames++) {
      if (this.terrain.isFull) return frames
      this.draw()
      await finished(this.renderer)
      // Promises and timers of loaders run.
      await new Promise(resolve => setTimeout(resolve))
    }
    throw new Error('bench: no full picture')
  }

  /** GPU time of frames [ms]. */
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
    this.terrain.update(this.renderer, this.camera, 0)
    return performance.now() - start
  }

  dispose(): void {
    this.#terrain?.dispose()
    this.#atmosphere.dispose()
    this.#target.dispose()
    release(this.renderer)
  }
}
