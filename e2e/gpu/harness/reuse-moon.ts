import { DataTexture, NearestFilter } from 'three'
import { ivec2, textureLoad, uv } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { MoonSurfaceMap as DrawnMap } from '../../../packages/atmosphere/src/moon/MoonSurfaceMap'
import { FragmentPass } from '../../../packages/atmosphere/src/tables/FragmentPass'
import { keepTexels, type Texels } from './kept-texels'
import { isKeepingTexels, readTexels, takeTexels, waitFor } from './reuse-tables'

/** The moon's map, reused just as tables are: a software renderer takes seconds for its million texels. */
export class MoonSurfaceMap extends DrawnMap {
  #renderer: Renderer | null = null

  override prepare(renderer: Renderer): void {
    if (renderer === this.#renderer) return
    this.#renderer = renderer
    const backend = 'isWebGPUBackend' in renderer.backend ? 'webgpu' : 'webgl'
    const key = `moon-${this.target.width}.${backend}`
    const kept = takeTexels(key)
    if (kept) {
      this.#restore(renderer, kept)
      return
    }
    super.prepare(renderer)
    if (isKeepingTexels()) waitFor(this.#keep(renderer, key))
  }

  async #keep(renderer: Renderer, key: string): Promise<void> {
    // Once the frame is drawn in which this is.
    await Promise.resolve()
    await keepTexels(key, [await readTexels<Texels>(renderer, this.target)])
  }

  #restore(renderer: Renderer, kept: Texels): void {
    const { width, height } = this.target
    const source = new DataTexture(kept, width, height)
    source.minFilter = source.magFilter = NearestFilter
    source.needsUpdate = true
    const texel = ivec2(uv().mul(width).floor())
    const copy = new FragmentPass('Reuse.moon', textureLoad(source, texel))
    copy.render(renderer, this.target)
    copy.dispose()
    source.dispose()
  }

  override dispose(): void {
    this.#renderer = null
    super.dispose()
  }
}
