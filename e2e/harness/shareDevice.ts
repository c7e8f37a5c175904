type Method = (...args: unknown[]) => unknown

/** Calls whose results live as long as their page does, so that the browser finds them again. */
const kept = [
  'createShaderModule',
  'createBindGroupLayout',
  'createPipelineLayout',
  'createRenderPipeline',
  'createRenderPipelineAsync',
  'createComputePipeline',
  'createComputePipelineAsync'
]

type RequestDevice = (this: GPUAdapter, descriptor?: GPUDeviceDescriptor) => Promise<GPUDevice>

interface SharedDevice {
  device: GPUDevice
  /** Textures and buffers since {@link freeResources} was last called. */
  resources: Set<GPUTexture | GPUBuffer>
}

const _devices = new Map<string, Promise<SharedDevice>>()
const _kept = new Set<unknown>()

function share(device: GPUDevice): SharedDevice {
  const resources = new Set<GPUTexture | GPUBuffer>()
  const methods = device as unknown as Record<string, Method>
  const collect = (name: string, into: Set<unknown>): void => {
    const create = methods[name].bind(device)
    methods[name] = (...args) => {
      const result = create(...args)
      void Promise.resolve(result).then(
        object => into.add(object),
        () => undefined
      )
      return result
    }
  }
  for (const name of kept) collect(name, _kept)
  collect('createTexture', resources)
  collect('createBuffer', resources)
  device.destroy = () => undefined
  return { device, resources }
}

/**
 * Has renderers of this page that ask for the same features and limits share one WebGPU device, whose
 * pipelines stay: a browser compiles a shader that it has seen on a device only once, and with a software
 * renderer compiling takes a third of the tests' time. Destroying the device does nothing.
 */
export function shareDevice(): void {
  if (!('GPUAdapter' in globalThis)) return
  const adapter: { requestDevice: RequestDevice } = GPUAdapter.prototype
  const request = adapter.requestDevice
  adapter.requestDevice = async function (descriptor = {}) {
    const features = [...(descriptor.requiredFeatures ?? [])].toSorted()
    const key = JSON.stringify([features, descriptor.requiredLimits])
    const shared = _devices.get(key) ?? request.call(this, descriptor).then(share)
    _devices.set(key, shared)
    return (await shared).device
  }
}

/** Destroys textures and buffers of shared devices. Renderers that have them must not draw any more. */
export async function freeResources(): Promise<void> {
  for (const { resources } of await Promise.all(_devices.values())) {
    for (const resource of resources) resource.destroy()
    resources.clear()
  }
}
