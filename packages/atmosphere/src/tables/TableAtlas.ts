import type { RenderTarget } from 'three'
import { DataUtils } from 'three'
import { texture, vec2 } from 'three/tsl'
import type { Renderer, TextureNode } from 'three/webgpu'
import { sampleLevel0, type Vec2, type Vec4 } from '../tsl-types'
import { vector2 } from '../uniforms'
import { tableTarget, type FragmentPass } from './FragmentPass'

/** A table as shaders read it, wherever it is kept. */
export interface Table {
  /**
   * Reads it bilinearly.
   *
   * @param uv - Texture coordinates of the table alone, in [0, 1]².
   */
  sample(uv: Vec2): Vec4
}

/** A texture as shaders read it by texels. */
export interface Texels {
  /**
   * Reads it bilinearly.
   *
   * @param texel - Column and row, whole numbers and a half in the middle of a texel.
   */
  at(texel: Vec2): Vec4
}

/** Texels between tables of an atlas, so that rounding mixes nothing of one into another. */
export const GAP = 2

/**
 * A half-float texture that several tables share: a shader that reads all of them samples one texture, of
 * the sixteen that it may.
 */
export class TableAtlas implements Texels {
  readonly target: RenderTarget
  /** The texture, a node that all shaders share. */
  readonly texture: TextureNode
  /** Size of a texel in texture coordinates; a uniform, for the atlas may grow. */
  readonly #texelSize = vector2()

  constructor(name: string, width: number, height: number) {
    this.target = tableTarget(name, width, height)
    this.texture = texture(this.target.texture)
    this.setSize(width, height)
  }

  /** Changes its size [texels]; if it is another, all tables are lost. */
  setSize(width: number, height: number): void {
    this.target.setSize(width, height)
    this.#texelSize.value.set(1 / width, 1 / height)
  }

  at(texel: Vec2): Vec4 {
    return sampleLevel0(this.texture, texel.mul(this.#texelSize))
  }

  /** A rectangle of it, as a table of its own [texels]. */
  region(x: number, y: number, width: number, height: number): TableRegion {
    return new TableRegion(this, x, y, width, height)
  }

  /** Size on the GPU [bytes]. */
  get bytes(): number {
    return 8 * this.target.width * this.target.height
  }

  dispose(): void {
    this.target.dispose()
  }
}

/** A table in a {@link TableAtlas}. */
export class TableRegion implements Table {
  constructor(
    readonly atlas: TableAtlas,
    /** First column and row in the atlas, and size [texels]. */
    readonly x: number,
    readonly y: number,
    readonly width: number,
    readonly height: number
  ) {}

  sample(uv: Vec2): Vec4 {
    return this.atlas.at(uv.mul(vec2(this.width, this.height)).add(vec2(this.x, this.y)))
  }

  /** Fills it by a pass, whose `uv()` spans the table alone. */
  render(renderer: Renderer, pass: FragmentPass): void {
    const { target } = this.atlas
    for (const box of [target.viewport, target.scissor]) {
      box.set(this.x, this.y, this.width, this.height)
    }
    target.scissorTest = true
    pass.render(renderer, target)
  }

  /** Reads it back: four numbers to a texel, row by row from the first. */
  async read(renderer: Renderer): Promise<Float32Array> {
    const { x, y, width, height } = this
    const { target } = this.atlas
    const backend = renderer.backend as { isWebGPUBackend?: boolean }
    // WebGL counts rows from the bottom, which texture coordinates call the last.
    const isBottomUp = backend.isWebGPUBackend !== true
    const first = isBottomUp ? target.height - y - height : y
    const read = await renderer.readRenderTargetPixelsAsync(target, x, first, width, height)
    const values = Float32Array.from(read, half => DataUtils.fromHalfFloat(half))
    if (!isBottomUp) return values
    const stride = 4 * width
    return values.map(
      (_, i) => values[(height - 1 - Math.floor(i / stride)) * stride + (i % stride)]
    )
  }
}
