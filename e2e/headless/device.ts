import { WebGPURenderer, type WebGPURendererParameters } from 'three/webgpu'
import { TimestampQuery } from 'three'
import { create, globals } from 'webgpu'

Object.assign(globalThis, globals)

/** Callbacks that wait for the next animation frame. */
let waiting: (() => void)[] = []

/** Lets an animation frame begin: what three draws once in each is drawn anew. */
export function nextFrame(): void {
  const callbacks = waiting
  waiting = []
  for (const callback of callbacks) callback()
}

/** A stand-in for the canvas that WebGPURenderer asks for; nothing is ever presented. */
function offscreenCanvas(width: number, height: number): HTMLCanvasElement {
  let texture: GPUTexture | undefined
  let device: GPUDevice | undefined
  const canvas = {
    width,
    height,
    style: {},
    addEventListener: () => undefined,
    removeEventListener: () => undefined,
    setAttribute: () => undefined,
    getContext: () => ({
      canvas,
      configure: (options: GPUCanvasConfiguration) => (device = options.device),
      unconfigure: () => texture?.destroy(),
      getCurrentTexture: () =>
        (texture ??= device!.createTexture({
          size: [canvas.width, canvas.height],
          format: 'bgra8unorm',
          usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC
        }))
    })
  }
  return canvas as unknown as HTMLCanvasElement
}

async function requestAdapter(gpu: GPU): Promise<GPUAdapter> {
  const adapter = await gpu.requestAdapter({ powerPreference: 'high-performance' })
  if (adapter === null) throw new Error('headless: no WebGPU adapter on this machine')
  return adapter
}

/** A device, named, and renderers on it that count GPU time. */
export class HeadlessDevice {
  readonly name: string
  readonly #gpu: GPU

  private constructor(gpu: GPU, adapter: GPUAdapter) {
    const { vendor, architecture, device, description } = adapter.info
    this.#gpu = gpu
    this.name = [description, device, vendor, architecture].find(text => text !== '') ?? 'unknown'
  }

  static async open(): Promise<HeadlessDevice> {
    // Dawn rounds timestamps to 0.1 ms unless told otherwise.
    const gpu = create(['disable-dawn-features=timestamp_quantization'])
    Object.defineProperty(globalThis, 'navigator', {
      value: { gpu, userAgent: 'node' },
      configurable: true
    })
    Object.assign(globalThis, {
      self: globalThis,
      requestAnimationFrame: (callback: () => void) => waiting.push(callback),
      cancelAnimationFrame: () => undefined
    })
    const adapter = await requestAdapter(gpu)
    if (!adapter.features.has('timestamp-query')) {
      throw new Error('headless: the adapter has no timestamp-query')
    }
    return new HeadlessDevice(gpu, adapter)
  }

  /** Lets go of the GPU: the process can end. */
  close(): void {
    Object.defineProperty(globalThis, 'navigator', { value: {}, configurable: true })
  }

  /**
   * A renderer on a device of its own.
   *
   * @param parameters - Parameters of the renderer, besides canvas and device.
   */
  async renderer(
    width: number,
    height: number,
    parameters: Partial<WebGPURendererParameters> = {}
  ): Promise<WebGPURenderer> {
    // An adapter serves one device.
    const adapter = await requestAdapter(this.#gpu)
    const device = await adapter.requestDevice({ requiredFeatures: ['timestamp-query'] })
    const renderer = new WebGPURenderer({
      canvas: offscreenCanvas(width, height),
      antialias: false,
      trackTimestamp: true,
      device,
      ...parameters
    })
    await renderer.init()
    renderer.setPixelRatio(1)
    renderer.setSize(width, height, false)
    return renderer
  }
}

/** GPU time of everything rendered since the last call [ms]. */
export async function gpuMilliseconds(renderer: WebGPURenderer): Promise<number> {
  await renderer.resolveTimestampsAsync(TimestampQuery.RENDER)
  // The renderer's own total leaves out passes that ran inside another.
  return gpuPasses(renderer).reduce((sum, value) => sum + value, 0)
}

/** GPU time of each pass, in the order in which they began; after `gpuMilliseconds` [ms]. */
export function gpuPasses(renderer: WebGPURenderer): number[] {
  const { timestampQueryPool } = renderer.backend as unknown as {
    timestampQueryPool: { render: { timestamps: Map<string, number> } }
  }
  return [...timestampQueryPool.render.timestamps.values()]
}

/** Disposes of a renderer and of its device: a driver has only so many. */
export function release(renderer: WebGPURenderer): void {
  const { device } = renderer.backend as unknown as { device: GPUDevice }
  void renderer.dispose()
  device.destroy()
}

/** Waits until the GPU has done all that was asked of it. */
export async function finished(renderer: WebGPURenderer): Promise<void> {
  await (renderer.backend as unknown as { device: GPUDevice }).device.queue.onSubmittedWorkDone()
}
