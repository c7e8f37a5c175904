import { photographicToneMapping } from '@welkin/atmosphere'
import { HalfFloatType, NoToneMapping, SRGBColorSpace } from 'three'
import { float, mix, renderOutput, rtt, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'

/** Values of each primary in the table, and the stops about 1 that they span. */
const SIZE = 48
const STOPS = [-12.5, 7] as const

/**
 * Tone mapping by a table: two look-ups in place of logarithms, powers and matrices for each pixel. It has
 * `photographicToneMapping` and sRGB, baked with the first frame: greys within half a level of 255, the brightest saturated colours within five.
 */
export class ToneTable {
  readonly #table = rtt(vec4(bakedColor(), 1), SIZE * SIZE, SIZE, {
    type: HalfFloatType,
    depthBuffer: false,
    autoUpdate: false
  })

  /**
   * A picture as it is shown: with colours of the display.
   *
   * @param picture - Exposed light, linear sRGB.
   */
  shown(picture: Node): Node<'vec4'> {
    const [darkest, brightest] = STOPS
    const light = (picture as Node<'vec4'>).rgb.max(2 ** darkest)
    const at = light
      .log2()
      .sub(darkest)
      .mul((SIZE - 1) / (brightest - darkest))
      .min(SIZE - 1)
      .toConst()
    const slice = at.z
      .floor()
      .min(SIZE - 2)
      .toConst()
    const texel = vec2(at.x.add(slice.mul(SIZE)), at.y)
      .add(0.5)
      .div(vec2(SIZE * SIZE, SIZE))
    const here = this.#table.sample(texel.toConst()).level(float(0)).rgb
    const next = this.#table.sample(texel.add(vec2(1 / SIZE, 0))).level(float(0)).rgb
    return vec4(mix(here, next, at.z.sub(slice)), 1)
  }

  /** Frees the table. */
  dispose(): void {
    this.#table.dispose()
  }
}

/** Colour of a texel: slices of blue beside each other. */
function bakedColor(): Node<'vec3'> {
  const [darkest, brightest] = STOPS
  const texel = uv()
    .mul(vec2(SIZE * SIZE, SIZE))
    .floor()
    .toConst()
  const slice = texel.x.add(0.5).div(SIZE).floor().toConst()
  const at = vec3(texel.x.sub(slice.mul(SIZE)), texel.y, slice)
  const light = at
    .mul((brightest - darkest) / (SIZE - 1))
    .add(darkest)
    .exp2()
  const shown = photographicToneMapping()(light, float(1)) as Node<'vec3'>
  return (renderOutput(vec4(shown, 1), NoToneMapping, SRGBColorSpace) as Node<'vec4'>).rgb
}
