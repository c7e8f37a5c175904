import { Atmosphere, aerialPerspective, raindrops } from '@welkin/atmosphere'
import {
  CloudLightTable,
  CloudNoise,
  cloudPreset,
  clouds,
  precipitationShafts
} from '@welkin/clouds'
import type { CloudLayers, CloudsNode } from '@welkin/clouds'
import { Ellipsoid } from '@welkin/geo'
import {
  ACESFilmicToneMapping,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  RenderTarget,
  Scene,
  SphereGeometry,
  Vector3
} from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import type { WebGPURenderer } from 'three/webgpu'
import { gpuMilliseconds, gpuPasses, nextFrame } from '../headless/device'
import { placeCamera, setSun } from './scene'
import { median } from './statistics'

/** Longitudes of the camera: under a broken sky, and inside of a closed one [°]. */
export const cloudViews = [
  { name: 'ground', altitude: 2, pitch: 12, longitude: 151.75 },
  { name: 'among', altitude: 1500, pitch: 0, longitude: 151.75 },
  { name: 'inside', altitude: 1500, pitch: 0, longitude: 150 },
  { name: '10 km', altitude: 10_000, pitch: -8, longitude: 151.75 },
  { name: '400 km', altitude: 400_000, pitch: -12, longitude: 151.75 }
] as const

export type CloudView = (typeof cloudViews)[number]

/** Frames before any are timed. */
const WARM_UP = 40

const _up = new Vector3()

function brokenCumulus(): CloudLayers {
  const layers = cloudPreset('fairWeather')
  layers.at(0).set({ coverage: 0.4 })
  return layers
}

/** GPU time of a frame, and of its passes [ms]. */
export interface FrameTimes {
  ms: number
  passes: number[]
}

/** Scattering of clouds and rain. */
export interface CloudBenchOptions {
  /** Default: lobes of a fair-weather cloud. */
  light?: CloudLightTable
  /** False for rain without rainbows. */
  hasRainbows?: boolean
}

/** Clouds over a globe, drawn as an app draws them: a pass, the air, the clouds. */
export class CloudBench {
  readonly node: CloudsNode
  readonly #renderer: WebGPURenderer
  readonly #target: RenderTarget
  readonly #pipeline: RenderPipeline
  readonly #atmosphere = new Atmosphere()
  readonly #camera: PerspectiveCamera
  readonly #air
  readonly #globe = new Mesh(
    new SphereGeometry(1, 256, 128).rotateX(Math.PI / 2),
    new MeshBasicMaterial({ color: 0x557799 })
  )
  readonly #noise = new CloudNoise()
  readonly #light: CloudLightTable
  /** Pose of the camera by `look`. */
  #pose = new Matrix4()
  #frame = 0

  constructor(
    renderer: WebGPURenderer,
    [width, height]: readonly [number, number],
    layers: CloudLayers = brokenCumulus(),
    { light = new CloudLightTable(), hasRainbows = true }: CloudBenchOptions = {}
  ) {
    this.#light = light
    this.#renderer = renderer
    renderer.toneMapping = ACESFilmicToneMapping
    const atmosphere = this.#atmosphere
    atmosphere.frame = 'ecef'
    const camera = (this.#camera = new PerspectiveCamera(50, width / height))
    this.#globe.scale.copy(Ellipsoid.WGS84.radii)
    this.#globe.updateMatrixWorld()
    const scenePass = pass(new Scene().add(this.#globe), camera, { samples: 0 })
    const depth = scenePass.getTextureNode('depth')
    this.#air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere)
    const rains = [...layers].some(layer => layer.precipitation?.rate)
    const drops = hasRainbows ? raindrops() : undefined
    const precipitation = rains ? precipitationShafts({ drops }) : undefined
    const options = { noise: this.#noise, light: this.#light, precipitation }
    this.node = clouds(this.#air, depth, camera, atmosphere, layers, options)
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputNode = this.node
    this.#target = new RenderTarget(width, height)
  }

  look({ altitude, pitch, longitude }: CloudView, sunElevation = 40): void {
    placeCamera(this.#camera, altitude, longitude)
    this.#camera.rotateX((pitch * Math.PI) / 180)
    this.#camera.updateMatrixWorld()
    this.#pose.copy(this.#camera.matrixWorld)
    setSun(this.#atmosphere, this.#camera, sunElevation)
  }

  /** Moves the camera off its pose by `look`: turned to the left [°], and back [m]. The sun stays. */
  displace(turn: number, back: number): void {
    const camera = this.#camera
    this.#pose.decompose(camera.position, camera.quaternion, camera.scale)
    camera.rotateOnWorldAxis(_up.copy(camera.up).normalize(), (turn * Math.PI) / 180)
    camera.translateZ(back)
    camera.updateMatrixWorld()
  }

  set withClouds(withClouds: boolean) {
    this.#pipeline.outputNode = withClouds ? this.node : this.#air
    this.#pipeline.needsUpdate = true
  }

  /** Draws frames at 60 a second, or one moment again and again; median GPU time [ms]. */
  async time(frames: number, isStill = false, warmUp = WARM_UP): Promise<FrameTimes> {
    const totals: number[] = []
    const each: number[][] = []
    for (let i = 0; i < warmUp + frames; i++) {
      this.draw(isStill)
      const ms = await gpuMilliseconds(this.#renderer)
      if (i < warmUp) continue
      totals.push(ms)
      gpuPasses(this.#renderer).forEach((value, k) => (each[k] ??= []).push(value))
    }
    return { ms: median(totals), passes: each.map(median) }
  }

  draw(isStill = false): void {
    nextFrame()
    this.node.time = isStill ? 0 : this.#frame++ / 60
    this.#renderer.setRenderTarget(this.#target)
    this.#pipeline.render()
    this.#renderer.setRenderTarget(null)
  }

  /** Picture of the canvas as a viewer sees it, RGBA. */
  async picture(): Promise<Uint8Array> {
    const { width, height } = this.#target
    const pixels = await this.#renderer.readRenderTargetPixelsAsync(
      this.#target,
      0,
      0,
      width,
      height
    )
    return pixels as Uint8Array
  }

  dispose(): void {
    this.#pipeline.dispose()
    this.node.dispose()
    this.#noise.dispose()
    this.#light.dispose()
    this.#atmosphere.dispose()
    this.#globe.geometry.dispose()
    this.#globe.material.dispose()
    this.#target.dispose()
  }
}
