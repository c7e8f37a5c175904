import { LinearFilter, LinearMipmapLinearFilter, RenderTarget, UnsignedByteType } from 'three'
import { Fn, uv } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { FragmentPass } from '../tables/FragmentPass'
import { moonGround, moonMapDirection } from './tsl/moonSurface'

/** Map of the moon's near side with mipmaps, drawn once on the GPU. See `moonGround` for its texels. */
export class MoonSurfaceMap {
  readonly target: RenderTarget
  readonly #pass = new FragmentPass(
    'Welkin.MoonSurface',
    Fn(() => moonGround(moonMapDirection(uv()).toConst() as never))()
  )
  #renderer: Renderer | null = null

  /** @param size - Width and height [texels]. */
  constructor(size: number) {
    this.target = new RenderTarget(size, size, {
      type: UnsignedByteType,
      depthBuffer: false,
      generateMipmaps: true,
      minFilter: LinearMipmapLinearFilter,
      magFilter: LinearFilter
    })
    this.target.texture.name = 'Welkin.Moon'
  }

  /** Draws the map unless this renderer has it already. */
  prepare(renderer: Renderer): void {
    if (renderer === this.#renderer) return
    this.#renderer = renderer
    this.#pass.render(renderer, this.target)
  }

  /** Frees GPU memory. The next {@link prepare} draws the map again. */
  dispose(): void {
    this.#renderer = null
    this.#pass.dispose()
    this.target.dispose()
  }
}
