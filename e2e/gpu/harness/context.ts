import { FloatType, RenderTarget, type Camera, type Scene, type TextureDataType } from 'three'
import { WebGPURenderer, type Node } from 'three/webgpu'
import { ConsoleWatch } from './console'
import { evaluateOnGpu } from './evaluate'
import type { Backend } from '../../harness/backend'
import { finishWork } from './graphics'
import { Picture, readPicture } from './picture'

export interface RendererOptions {
  width?: number
  height?: number
  antialias?: boolean
  alpha?: boolean
  reversedDepthBuffer?: boolean
  logarithmicDepthBuffer?: boolean
}

export interface RenderOptions {
  width?: number
  height?: number
  type?: TextureDataType
  samples?: number
}

export const defaultWidth = 320
export const defaultHeight = 180

/** Tools of a GPU test. All that it creates is disposed when the test ends. */
export interface GpuContext {
  readonly backend: Backend
  /** An initialised renderer of this backend on a canvas that no page shows; 320×180, pixel ratio 1. */
  createRenderer: (options?: RendererOptions) => Promise<WebGPURenderer>
  /** One that shows metres and a planet at once. */
  createPlanetRenderer: (options?: RendererOptions) => Promise<WebGPURenderer>
  /** Renders to a float32 target (linear, before tone mapping) and reads it back. */
  render: (
    renderer: WebGPURenderer,
    scene: Scene,
    camera: Camera,
    options?: RenderOptions
  ) => Promise<Picture>
  /** Draws to the canvas, and reads it as a viewer sees it: sRGB in [0, 1]. */
  capture: (renderer: WebGPURenderer, draw: () => void) => Promise<Picture>
  /** Runs a shader function on each input; four results per input. */
  evaluate: (
    inputs: readonly (readonly number[])[],
    body: (input: Node<'vec4'>) => Node
  ) => Promise<Float32Array>
  /** Lets a console message that the test means to cause pass. */
  allowConsole: (pattern: RegExp) => void
  /** A line for the report, shown beside the test's name. */
  note: (text: string) => void
}

async function createRenderer(
  backend: Backend,
  { width = defaultWidth, height = defaultHeight, antialias = false, ...rest }: RendererOptions
): Promise<WebGPURenderer> {
  const canvas = document.createElement('canvas')
  const renderer = new WebGPURenderer({
    canvas,
    antialias,
    forceWebGL: backend === 'webgl',
    ...rest
  })
  renderer.setPixelRatio(1)
  renderer.setSize(width, height)
  await renderer.init()
  const isWebGPU = 'isWebGPUBackend' in renderer.backend
  if (isWebGPU !== (backend === 'webgpu')) throw new Error(`no ${backend} backend in this browser`)
  return renderer
}

async function renderToPicture(
  renderer: WebGPURenderer,
  scene: Scene,
  camera: Camera,
  options: RenderOptions
): Promise<Picture> {
  const { width = defaultWidth, height = defaultHeight, type = FloatType, samples = 0 } = options
  const target = new RenderTarget(width, height, { type, samples })
  const previous = renderer.getRenderTarget()
  renderer.setRenderTarget(target)
  renderer.render(scene, camera)
  renderer.setRenderTarget(previous)
  const picture = await readPicture(renderer, target)
  target.dispose()
  return picture
}

async function captureCanvas(renderer: WebGPURenderer, draw: () => void): Promise<Picture> {
  draw()
  // In the task of the drawing: later, a WebGPU canvas reads as blank.
  const url = renderer.domElement.toDataURL('image/png')
  const image = new Image()
  image.src = url
  await image.decode()
  const { width, height } = image
  const context2d = new OffscreenCanvas(width, height).getContext('2d')!
  context2d.drawImage(image, 0, 0)
  const bytes = context2d.getImageData(0, 0, width, height).data
  return new Picture(
    width,
    height,
    Float32Array.from(bytes, value => value / 255)
  )
}

export interface ContextHandle {
  context: GpuContext
  finish: () => Promise<{ messages: string[]; notes: string[] }>
}

export function createContext(backend: Backend): ContextHandle {
  const watch = new ConsoleWatch()
  const renderers: WebGPURenderer[] = []
  const notes: string[] = []
  let evaluator: Promise<WebGPURenderer> | undefined

  const context: GpuContext = {
    backend,
    async createRenderer(options = {}) {
      const renderer = await createRenderer(backend, options)
      renderers.push(renderer)
      return renderer
    },
    async createPlanetRenderer(options) {
      const renderer = await context.createRenderer({ ...options, reversedDepthBuffer: true })
      renderer.highPrecision = true
      return renderer
    },
    render: (renderer, scene, camera, options = {}) =>
      renderToPicture(renderer, scene, camera, options),
    capture: captureCanvas,
    async evaluate(inputs, body) {
      evaluator ??= context.createRenderer()
      return evaluateOnGpu(await evaluator, inputs, body)
    },
    allowConsole: pattern => watch.allow(pattern),
    note: text => notes.push(text)
  }

  return {
    context,
    async finish() {
      // A frame later: pipeline errors of WebGPU arrive asynchronously.
      await new Promise(resolve => setTimeout(resolve, 20))
      for (const renderer of renderers) {
        // The next test must not wait for what this one has queued.
        await finishWork(renderer)
        await renderer.dispose()
      }
      return { messages: watch.stop(), notes }
    }
  }
}
