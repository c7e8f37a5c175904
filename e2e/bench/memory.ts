import { cloudQualities, type CloudQualityName } from '@welkin/clouds'
import { release, type HeadlessDevice } from '../headless/device'
import { CloudBench, cloudViews } from './CloudBench'

/** Textures of the clouds on the GPU, by what they are for [bytes]. */
export interface CloudMemory {
  quality: CloudQualityName
  renderTargets: number
  shadowMaps: number
  noise: number
}

/** The formats that Welkin asks for [bytes a texel]. */
const TEXEL_BYTES: Partial<Record<GPUTextureFormat, number>> = {
  r8unorm: 1,
  rg8unorm: 2,
  rgba8unorm: 4,
  r16float: 2,
  rg16float: 4,
  rgba16float: 8,
  r32float: 4,
  rg32float: 8,
  rgba32float: 16
}

/** Bytes of a texture, its levels of detail included. */
export function bytesOf(texture: GPUTexture): number {
  const bytes = TEXEL_BYTES[texture.format]
  if (bytes === undefined) throw new Error(`bench: no size is known of ${texture.format}`)
  let sum = 0
  for (let level = 0; level < texture.mipLevelCount; level++) {
    const side = (size: number): number => Math.max(size >> level, 1)
    const layers =
      texture.dimension === '3d' ? side(texture.depthOrArrayLayers) : texture.depthOrArrayLayers
    sum += bytes * side(texture.width) * side(texture.height) * layers
  }
  return sum
}

/** Labels of the textures of each kind: three gives a texture's name to the GPU's. */
const KINDS = {
  renderTargets: /^Welkin\.Clouds(?!Shadows)/,
  shadowMaps: /^Welkin\.CloudShadows/,
  noise: /^Welkin\.CloudNoise/
}

/** Keeps a list of the textures that a device has at present. */
export function watchTextures(device: GPUDevice): Set<GPUTexture> {
  const alive = new Set<GPUTexture>()
  const create = device.createTexture.bind(device)
  device.createTexture = descriptor => {
    const made = create(descriptor)
    const destroy = made.destroy.bind(made)
    made.destroy = () => {
      alive.delete(made)
      destroy()
    }
    alive.add(made)
    return made
  }
  return alive
}

/** Memory that clouds take at each quality. */
export async function measureCloudMemory(
  device: HeadlessDevice,
  size: readonly [number, number]
): Promise<CloudMemory[]> {
  const renderer = await device.renderer(...size)
  const alive = watchTextures((renderer.backend as unknown as { device: GPUDevice }).device)
  const bench = new CloudBench(renderer, size)
  bench.look(cloudViews[0])
  const measured: CloudMemory[] = []
  for (const quality of Object.keys(cloudQualities) as CloudQualityName[]) {
    bench.node.quality = quality
    for (let i = 0; i < 4; i++) bench.draw()
    const of = (pattern: RegExp): number => {
      const found = [...alive].filter(({ label }) => pattern.test(label))
      if (found.length === 0) throw new Error(`bench: no texture is labelled ${pattern}`)
      return found.reduce((sum, texture) => sum + bytesOf(texture), 0)
    }
    measured.push({
      quality,
      renderTargets: of(KINDS.renderTargets),
      shadowMaps: of(KINDS.shadowMaps),
      noise: of(KINDS.noise)
    })
  }
  bench.dispose()
  release(renderer)
  return measured
}
