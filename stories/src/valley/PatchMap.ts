import {
  LinearFilter,
  LinearMipmapLinearFilter,
  MirroredRepeatWrapping,
  NoColorSpace,
  RGFormat,
  UnsignedByteType
} from 'three'
import { positionWorld, rtt, uv, vec2, vec3 } from 'three/tsl'
import type { Node } from 'three/webgpu'

/** Edge of the square that the map covers, and its middle along the valley [m]: as far as there are mountains to see. */
const WIDTH = 26_000
const MIDDLE = -3500

/** Texels along an edge. Fewer: woods and meadows have straight edges (*Valley, all day*). */
const SIZE = 2048

/** Greatest deviation of the noise in each channel of the map. */
const MOST = 2

/** Coarse noise of the ground, which is drawn once with the first frame: a pixel reads it at once in place of noise by noise. */
export class PatchMap {
  readonly #map

  /** @param noise - Two kinds of noise in [−{@link MOST}, {@link MOST}] at a place [m], in cells that are not much finer than a texel. */
  constructor(noise: (place: Node<'vec3'>) => Node<'vec2'>) {
    const { x, y } = uv().sub(0.5).mul(WIDTH)
    const deviation = noise(vec3(x, 0, y.add(MIDDLE)))
    this.#map = rtt(deviation.div(2 * MOST).add(0.5), SIZE, SIZE, {
      type: UnsignedByteType,
      format: RGFormat,
      colorSpace: NoColorSpace,
      depthBuffer: false,
      generateMipmaps: true,
      minFilter: LinearMipmapLinearFilter,
      magFilter: LinearFilter,
      wrapS: MirroredRepeatWrapping,
      wrapT: MirroredRepeatWrapping,
      autoUpdate: false
    })
  }

  /**
   * The noise on the ground.
   *
   * @param place - A place [m]; that of the fragment, left out.
   * @param level - Level of detail; left out, that of the fragment.
   */
  sample({ x, z }: Node<'vec3'> = positionWorld, level: Node<'float'> | null = null): Node<'vec2'> {
    const at = vec2(x, z.sub(MIDDLE)).div(WIDTH).add(0.5)
    const read = this.#map.sample(at)
    const texel = (level === null ? read : read.level(level)) as unknown as Node<'vec4'>
    return texel.xy.sub(0.5).mul(2 * MOST)
  }

  /** Frees the map. */
  dispose(): void {
    this.#map.dispose()
  }
}
