import {
  Box3,
  Data3DTexture,
  NearestFilter,
  RedFormat,
  RenderTarget,
  Vector3,
  type RenderTarget3D
} from 'three'
import { int, ivec2, ivec3, screenCoordinate, texture3DLoad, vec4 } from 'three/tsl'
import type { Node, Renderer } from 'three/webgpu'
import { FragmentPass } from '../../../packages/atmosphere/src/tables/FragmentPass'
import {
  CloudNoise as BakedNoise,
  type CloudNoiseOptions
} from '../../../packages/clouds/src/noise/CloudNoise'
import { keepTexels, type Texels } from './kept-texels'
import { isKeepingTexels, readTexels, takeTexels, waitFor } from './reuse-tables'

const pixel = (): Node<'ivec2'> => ivec2(int(screenCoordinate.x), int(screenCoordinate.y))

/** A level of a volume, whose slices lie side by side in a picture. */
interface Level {
  level: number
  /** Texels along an edge. */
  size: number
  /** Columns of slices, and size of the picture [pixels]. */
  columns: number
  width: number
  height: number
}

/** Levels of a volume, finest first. */
function levelsOf(volume: RenderTarget3D): Level[] {
  return Array.from({ length: Math.log2(volume.width) + 1 }, (_, level) => {
    const size = volume.width >> level
    const columns = Math.min(size, 8)
    return { level, size, columns, width: size * columns, height: size ** 2 / columns }
  })
}

/**
 * Texels of a level, slice by slice, from a picture of them side by side.
 *
 * @param isUp - True if the volume's rows go up, as those of targets do on WebGL.
 */
function unfold(
  picture: Texels,
  { size, columns, width }: Level,
  channels: number,
  isUp: boolean
): Texels {
  const texels = new Uint8Array(channels * size ** 3)
  let to = 0
  for (let slice = 0; slice < size; slice++) {
    const [left, top] = [size * (slice % columns), size * Math.floor(slice / columns)]
    for (let y = 0; y < size; y++) {
      const row = top + (isUp ? size - 1 - y : y)
      for (let x = 0; x < size; x++) {
        const from = 4 * (row * width + left + x)
        for (let channel = 0; channel < channels; channel++) texels[to++] = picture[from + channel]
      }
    }
  }
  return texels
}

const channelsOf = ({ texture }: RenderTarget3D): number => (texture.format === RedFormat ? 1 : 4)

/** Keeps a volume's levels, for this page and those to come. */
async function keep(renderer: Renderer, volume: RenderTarget3D, key: string): Promise<void> {
  const levels = levelsOf(volume).map(async each => {
    const { level, size, columns, width, height } = each
    const options = {
      depthBuffer: false,
      minFilter: NearestFilter,
      magFilter: NearestFilter
    } as const
    const picture = new RenderTarget(width, height, options)
    const { x, y } = pixel().toConst()
    const slice = y.div(size).mul(columns).add(x.div(size))
    const texel = ivec3(x.mod(int(size)), y.mod(int(size)), slice)
    const copy = new FragmentPass(
      'Reuse.keep',
      vec4(texture3DLoad(volume.texture, texel, int(level)))
    )
    copy.render(renderer, picture)
    copy.dispose()
    const texels = await readTexels<Texels>(renderer, picture).finally(() => picture.dispose())
    return unfold(texels, each, channelsOf(volume), !('isWebGPUBackend' in renderer.backend))
  })
  await keepTexels(key, await Promise.all(levels))
}

/** Copies kept levels into a volume, in as many steps as the library's bake takes. */
function* restore(
  renderer: Renderer,
  volume: RenderTarget3D,
  kept: Texels
): Generator<number, void, void> {
  renderer.initRenderTarget(volume)
  let offset = 0
  for (const { level, size } of levelsOf(volume)) {
    const texels = kept.subarray(offset, (offset += channelsOf(volume) * size ** 3))
    const source = new Data3DTexture(texels, size, size, size)
    source.format = volume.texture.format
    source.needsUpdate = true
    const all = new Box3(new Vector3(), new Vector3(size, size, size))
    renderer.copyTextureToTexture(source, volume.texture, all, null, 0, level)
    source.dispose()
    // The library draws coarser levels outside of the volume first.
    for (let step = 0; step < (level > 0 ? 2 : 1) * size; step++) yield 1
  }
}

/** Clouds' noise, reused just as tables are. */
export class CloudNoise extends BakedNoise {
  constructor(options: CloudNoiseOptions = {}) {
    super(options)
    if (options.weather === undefined) this.#reuse('weather')
    if (options.shape === undefined) this.#reuse('shape')
    if (options.detail === undefined) this.#reuse('detail')
  }

  #reuse(name: 'weather' | 'shape' | 'detail'): void {
    const { [name]: volume } = this
    const bake = volume.bake.bind(volume)
    volume.bake = function* (renderer) {
      const key = 'isWebGPUBackend' in renderer.backend ? `${name}.webgpu` : `${name}.webgl`
      const kept = takeTexels(key)
      if (kept) {
        yield* restore(renderer, volume.target, kept)
        return
      }
      yield* bake(renderer)
      if (isKeepingTexels()) waitFor(keep(renderer, volume.target, key))
    }
  }
}
