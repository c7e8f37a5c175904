import { Atmosphere, aerialPerspective } from '@welkin/atmosphere'
import { CloudLightTable, CloudNoise, cloudPreset, cloudQualities, clouds } from '@welkin/clouds'
import type { CloudLayers, CloudQuality, CloudQualityName, CloudsNode } from '@welkin/clouds'
import { Ellipsoid } from '@welkin/geo'
import {
  ACESFilmicToneMapping,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  RenderTarget,
  Scene,
  SphereGeometry
} from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import type { WebGPURenderer } from 'three/webgpu'
import {
  gpuMilliseconds,
  gpuPasses,
  nextFrame,
  release,
  type HeadlessDevice
} from '../headless/device'
import { placeCamera, setSun } from './scene'
import { median } from './statistics'

/** Where clouds are looked at from: longitudes of a broken sky, and of a closed one to be inside of [°]. */
export const cloudViews = [
  { name: 'ground', altitude: 2, pitch: 12, longitude: 151.75 },
  { name: 'among', altitude: 1500, pitch: 0, longitude: 151.75 },
  { name: 'inside', altitude: 1500, pitch: 0, longitude: 150 },
  { name: '10 km', altitude: 10_000, pitch: -8, longitude: 151.75 },
  { name: '400 km', altitude: 400_000, pitch: -12, longitude: 151.75 }
] as const

export type CloudViewName = (typeof cloudViews)[number]['name']

/** What clouds cost in a view. */
export interface CloudCost {
  view: CloudViewName
  quality: CloudQualityName
  /** GPU time of the clouds alone: with them less without [ms]. */
  ms: number
  /** Of the largest passes, in the order in which they are drawn [ms]. */
  passes: number[]
  /** Of a picture that stands still, against `cloudReference` [dB]. */
  psnr: number
}

/** Frames before any are timed, and frames in which a picture that stands still settles: two seconds. */
const WARM_UP = 40
const SETTLING = 120

/** Slices of noise that a node draws in a frame, and frames that this takes. */
const NOISE_SLICES = 24
const NOISE_FRAMES = 28

function brokenCumulus(): CloudLayers {
  const layers = cloudPreset('fairWeather')
  layers.at(0).set({ coverage: 0.4 })
  return layers
}

/** A view of clouds over a globe. */
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
  readonly #light = new CloudLightTable()
  #frame = 0

  constructor(
    renderer: WebGPURenderer,
    [width, height]: readonly [number, number],
    layers: CloudLayers = brokenCumulus()
  ) {
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
    const options = { noise: this.#noise, light: this.#light }
    this.node = clouds(this.#air, depth, camera, atmosphere, layers, options)
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputNode = this.node
    this.#target = new RenderTarget(width, height)
  }

  look({ altitude, pitch, longitude }: (typeof cloudViews)[number], sunElevation = 40): void {
    placeCamera(this.#camera, altitude, longitude)
    this.#camera.rotateX((pitch * Math.PI) / 180)
    this.#camera.updateMatrixWorld()
    setSun(this.#atmosphere, this.#camera, sunElevation)
  }

  set withClouds(withClouds: boolean) {
    this.#pipeline.outputNode = withClouds ? this.node : this.#air
    this.#pipeline.needsUpdate = true
  }

  /** Draws frames at 60 a second, or one moment again and again; median GPU time [ms]. */
  async time(frames: number, isStill = false): Promise<{ ms: number; passes: number[] }> {
    const totals: number[] = []
    const each: number[][] = []
    for (let i = 0; i < WARM_UP + frames; i++) {
      this.draw(isStill)
      const ms = await gpuMilliseconds(this.#renderer)
      if (i < WARM_UP) continue
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

  /** What a viewer sees, RGBA. */
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

/** Every pixel, with an eighth of the steps' length of `high`, nothing remembered. */
export const cloudReference: CloudQuality = {
  steps: 1024,
  stepGrowth: cloudQualities.high.stepGrowth / 8,
  shortestStep: cloudQualities.high.shortestStep / 8,
  layerSteps: cloudQualities.high.layerSteps * 8,
  lightSteps: 4,
  block: 1
}

/** Peak signal-to-noise ratio of colours in [0, 255] [dB]. */
export function psnr(a: Uint8Array, b: Uint8Array): number {
  let sum = 0
  for (let i = 0; i < a.length; i++) if (i % 4 < 3) sum += (a[i] - b[i]) ** 2
  return 10 * Math.log10(255 ** 2 / (sum / (0.75 * a.length)))
}

/** What clouds cost at every quality in every view, and how near they come to the reference. */
export async function timeClouds(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number
): Promise<CloudCost[]> {
  const renderer = await device.renderer(...size)
  const bench = new CloudBench(renderer, size)
  const { node } = bench
  const costs: CloudCost[] = []
  for (const view of cloudViews) {
    bench.look(view)
    bench.withClouds = false
    const without = await bench.time(Math.min(frames, 5))
    bench.withClouds = true
    node.accumulates = false
    node.quality = cloudReference
    // Each of the shadow maps, at least once.
    for (let i = 0; i < 4; i++) bench.draw(true)
    const reference = await bench.picture()
    node.accumulates = true
    for (const quality of ['low', 'medium', 'high', 'ultra'] as const) {
      node.quality = quality
      const { ms, passes } = await bench.time(frames)
      for (let i = 0; i < SETTLING; i++) bench.draw(true)
      const picture = await bench.picture()
      costs.push({
        view: view.name,
        quality,
        ms: ms - without.ms,
        passes,
        psnr: psnr(picture, reference)
      })
    }
  }
  bench.dispose()
  void renderer.dispose()
  return costs
}

/** GPU time of the noise, drawn in slices as a node does: in all, and the most in a frame [ms]. */
export async function timeNoise(device: HeadlessDevice): Promise<{ total: number; most: number }> {
  const renderer = await device.renderer(64, 36)
  const runs: { total: number; most: number }[] = []
  for (let run = 0; run < 3; run++) {
    const noise = new CloudNoise()
    const times: number[] = []
    for (let isReady = false; !isReady && times.length < 10 * NOISE_FRAMES;) {
      isReady = noise.update(renderer, NOISE_SLICES)
      times.push(await gpuMilliseconds(renderer))
    }
    runs.push({ total: times.reduce((sum, ms) => sum + ms, 0), most: Math.max(...times) })
    noise.dispose()
  }
  release(renderer)
  return { total: median(runs.map(run => run.total)), most: median(runs.map(run => run.most)) }
}
