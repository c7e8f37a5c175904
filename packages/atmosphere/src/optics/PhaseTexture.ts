import { DataTexture, DataUtils, HalfFloatType, LinearFilter, RGBAFormat } from 'three'
import { texture } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { HALF_TEXELS } from './cpu/phaseRow'

/** Texture of phase functions, a row each, for `samplePhase`. */
export class PhaseTexture {
  readonly texture: DataTexture
  readonly node: TextureNode

  /** @param name - Name of the feature that it belongs to. */
  constructor(name: string, rows: number) {
    const width = 2 * HALF_TEXELS
    const texels = new Uint16Array(4 * width * rows)
    this.texture = new DataTexture(texels, width, rows, RGBAFormat, HalfFloatType)
    this.texture.name = `Welkin.${name}`
    this.texture.minFilter = this.texture.magFilter = LinearFilter
    this.node = texture(this.texture)
  }

  /** Replaces rows from the first one on. @param texels - Four numbers each [1/sr]. */
  write(texels: ArrayLike<number>): void {
    const data = this.texture.image.data as unknown as Uint16Array
    for (let i = 0; i < texels.length; i++) data[i] = DataUtils.toHalfFloat(texels[i])
    this.texture.needsUpdate = true
  }
}
