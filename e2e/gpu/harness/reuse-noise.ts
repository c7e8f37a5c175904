import { DataTexture, NearestFilter, RenderTarget, type RenderTarget3D } from 'three'
import {
  int,
  ivec2,
  ivec3,
  screenCoordinate,
  texture3DLoad,
  textureLoad,
  uniform,
  uv,
  vec4
} from 'three/tsl'
import type { Node, Renderer } from 'three/webgpu'
import { FragmentPass } from '../../../packages/atmosphere/src/tables/FragmentPass'
import {
  CloudNoise as BakedNoise,
  type CloudNoiseOptions
} from '../../../packages/clouds/src/noise/CloudNoise'
import { keepTexels, keptTexels, type Texels } from './kept-texels'
import { isReusingTables, readTexels, waitFor } from './reuse-tables'

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

/** Keeps a volume's levels, for this page and those to come. */
async function keep(renderer: Renderer, volume: RenderTarget3D, key: string): Promise<void> {
  const pictures = levelsOf(volume).map(({ level, size, columns, width, height }) => {
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
    return readTexels<Texels>(renderer, picture).finally(() => picture.dispose())
  })
  await keepTexels(key, await Promise.all(pictures))
}

/** Copies kept levels into a volume, in as many steps as the library's bake takes. */
function* restore(
  renderer: Renderer,
  volume: RenderTarget3D,
  kept: Texels
): Generator<number, void, void> {
  let offset = 0
  for (const { level, size, columns, width, height } of levelsOf(volume)) {
    const texels = kept.subarray(offset, (offset += 4 * size ** 3))
    const source = new DataTexture(texels, width, height)
    source.minFilter = source.magFilter = NearestFilter
    source.needsUpdate = true
    const corner = [uniform(0, 'int'), uniform(0, 'int')]
    // By uv: `screenCoordinate` takes a level for as large as the volume.
    const texel = ivec2(uv().mul(size).floor()).add(ivec2(corner[0], corner[1]))
    const copy = new FragmentPass('Reuse.noise', textureLoad(source, texel))
    try {
      for (let slice = 0; slice < size; slice++) {
        corner[0].value = size * (slice % columns)
        corner[1].value = size * Math.floor(slice / columns)
        copy.render(renderer, volume, slice, level)
        yield 1
        // The library draws coarser levels outside of the volume first.
        if (level > 0) yield 1
      }
    } finally {
      copy.dispose()
      source.dispose()
    }
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
      const kept = isReusingTables() ? keptTexels(key) : undefined
      if (kept) {
        yield* restore(renderer, volume.target, kept)
        return
      }
      yield* bake(renderer)
      if (isReusingTables()) waitFor(keep(renderer, volume.target, key))
    }
  }
}
