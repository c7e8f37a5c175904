import {
  photographicToneMapping,
  purkinjeShift,
  type AutoExposureNode,
  type Sight
} from '@welkin/atmosphere'
import { CustomToneMapping, InstancedMesh } from 'three'
import type { Camera, Mesh, PerspectiveCamera, Scene } from 'three'
import { WebGPURenderer } from 'three/webgpu'
import type { Node } from 'three/webgpu'
import type { Air, AirPath } from './air'
import type { Explorer } from './moving/Explorer'
import type { Weather } from './valley/weather'

/** A scene that draws itself, apart from the page and the clock: what a story shows and a test drives. */
export interface SceneHandle<Args> {
  readonly renderer: WebGPURenderer
  readonly scene: Scene
  readonly camera: Camera
  /** Moves the camera; the page shows its keys and keeps the view in the address. */
  readonly explorer?: Explorer
  /** Solar time [h] and weather as they are shown now, for tests. */
  readonly conditions?: { hour: number; weather: Weather }
  /** Settles when everything that the current view needs is loaded. */
  readonly ready: Promise<void>
  /** Fraction that is loaded, in [0, 1]. */
  readonly progress: number
  /** Draws one frame. The same arguments and size give the same pixels once `ready`. */
  render(): void
  /** @param pixelRatio - Device pixels per CSS pixel; width and height are CSS pixels. */
  resize(width: number, height: number, pixelRatio: number): void
  update(args: Partial<Args>): void
  /** Called with arguments that the scene changed of itself; whoever shows them sets it. */
  onArgs?: (changes: Partial<Args>) => void
  dispose(): void
}

export interface RendererArgs {
  /** Draw with WebGL 2 even where WebGPU is available. */
  forceWebGL: boolean
  /** Path by which the air is drawn. */
  path: AirPath
  /** Draw one reproducible frame, with no controls, and stop. */
  frame: boolean
}

/** Date of a scene and exposure of its picture. */
export interface TimeArgs {
  /** A moment of the day [ms since 1970]. */
  day: number
  /** Hour of that day, UTC [h]. */
  hour: number
  /** [stops], 0 for daylight. */
  exposure: number
}

export type CreateScene<Args extends RendererArgs> = (
  canvas: HTMLCanvasElement,
  args: Args
) => Promise<SceneHandle<Args>>

/**
 * Frames to draw before one counts. three r187 updates the matrices of a shadow after the objects that use them, and
 * in a `pass()` one frame later still.
 */
export const WARM_UP_FRAMES = 2

/**
 * Frames to draw before one counts where the picture sets its exposure: from daylight's scale half floats take three
 * pictures to a night's.
 */
export const EXPOSURE_FRAMES = 3

/** Longest time between two frames that counts: hidden pages get none, and time goes on from where it was [s]. */
const LONGEST_FRAME = 0.1

/**
 * Clock of a scene.
 *
 * @param isStill - True for a single frame, in which no time passes.
 * @returns Seconds since the call before; 0 for the first.
 */
export function frameClock(isStill: boolean): () => number {
  let last: number | undefined
  return () => {
    const now = performance.now()
    const seconds = isStill || last === undefined ? 0 : (now - last) / 1000
    last = now
    return Math.min(seconds, LONGEST_FRAME)
  }
}

/** A function that says whether a value, compared as text, is another than the last time; the first time it is. */
export function changeOf(): (value: object) => boolean {
  let last: string | undefined
  return value => {
    const text = JSON.stringify(value)
    const isOther = text !== last
    last = text
    return isOther
  }
}

/**
 * Draws the frames of a still, each exposed as the one before asks for.
 *
 * @param draw - Draws one.
 * @param exposure - Exposure that all of them settle; left out, there is none.
 */
export async function drawSettled(
  frames: number,
  draw: () => void,
  exposure?: () => Pick<AutoExposureNode, 'settle'> | undefined
): Promise<void> {
  for (let i = 0; i < frames; i++) {
    await new Promise(resolve => requestAnimationFrame(resolve))
    draw()
    await exposure?.()?.settle()
  }
}

/** Frees meshes with their geometries and materials. */
export function disposeMeshes(meshes: readonly Mesh[]): void {
  for (const mesh of meshes) {
    mesh.geometry.dispose()
    for (const material of [mesh.material].flat()) material.dispose()
    if (mesh instanceof InstancedMesh) mesh.dispose()
  }
}

/**
 * @param trackTimestamp - True to keep the GPU's time.
 * @param isPost - True where a pipeline draws all of the canvas, which then needs neither samples nor depth.
 * @param sight - Eyes that see nights, where no `autoExposure` does that.
 */
export async function createRenderer(
  canvas: HTMLCanvasElement,
  forceWebGL: boolean,
  trackTimestamp = false,
  isPost = false,
  sight?: Sight
): Promise<WebGPURenderer> {
  // One float depth buffer, reversed, holds from 1 m to several Earth radii on both backends.
  const renderer = new WebGPURenderer({
    canvas,
    antialias: !isPost,
    depth: !isPost,
    forceWebGL,
    trackTimestamp,
    reversedDepthBuffer: true
  })
  renderer.highPrecision = true
  renderer.shadowMap.enabled = true
  const tones = photographicToneMapping()
  const seen = (color: Node): Node => (sight ? purkinjeShift(color as Node<'vec3'>, sight) : color)
  renderer.library.addToneMapping((color, factor) => tones(seen(color), factor), CustomToneMapping)
  renderer.toneMapping = CustomToneMapping
  await renderer.init()
  return renderer
}

/**
 * Photographic stops to a factor of brightness.
 *
 * @param stops - 0 suits daylight; each stop more doubles the brightness.
 */
export function exposureOf(stops: number): number {
  return 2 ** stops
}

/**
 * @param day - Any moment of the day, milliseconds since 1970.
 * @param hour - Hours of that day, UTC.
 */
export function dateOf(day: number, hour: number): Date {
  const date = new Date(day)
  date.setUTCHours(0, 0, 0, 0)
  return new Date(date.getTime() + hour * 3_600_000)
}

/** Lets the sun and the exposure follow a story's arguments. */
export function applyTime(
  renderer: WebGPURenderer,
  { atmosphere }: Air,
  { day, hour, exposure }: TimeArgs
): void {
  atmosphere.date = dateOf(day, hour)
  renderer.toneMappingExposure = exposureOf(exposure)
}

/**
 * Fits a renderer and a camera to the size of a canvas.
 *
 * @param pixelRatio - Device pixels per CSS pixel; width and height are CSS pixels.
 */
export function fitToCanvas(
  renderer: WebGPURenderer,
  camera: PerspectiveCamera,
  width: number,
  height: number,
  pixelRatio: number
): void {
  renderer.setPixelRatio(pixelRatio)
  renderer.setSize(width, height, false)
  camera.aspect = width / height
  camera.updateProjectionMatrix()
}
