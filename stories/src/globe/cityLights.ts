import { ImageLoader, MathUtils, RedFormat } from 'three'
import type { DataTexture } from 'three'
import { attribute, float, texture, uniform, vec3 } from 'three/tsl'
import type { Node, UniformNode } from 'three/webgpu'
import { mipmapped } from '../mipmapped'
import { pixelsOf } from '../pixels'

/** Luminance of the brightest cities as a whole, seen from above [cd/m²]. */
const BRIGHTEST = 2

/** Towns by night: emission of the land, in the unit of an atmosphere's nodes. */
export interface CityLights {
  /** `luminanceScale` of the atmosphere. */
  readonly scale: UniformNode<'float', number>
  readonly emission: Node<'vec3'>
  dispose(): void
}

/**
 * Share of towns in each texel of a picture of the Earth by night. It is found before the picture is made smaller: from
 * afar towns are small beside land and sea, which are blue in it.
 */
function townsOf(picture: HTMLImageElement): DataTexture {
  const { width, height } = picture
  const data = pixelsOf(picture, 'createCityLights')
  return mipmapped(townShares(data), width, height, RedFormat)
}

/**
 * Shares of towns of pixels, in bytes.
 *
 * @param pixels - RGBA.
 */
export function townShares(pixels: ArrayLike<number>): Uint8Array {
  const shares = new Uint8Array(pixels.length / 4)
  for (let i = 0; i < shares.length; i++) {
    const yellow = (pixels[4 * i] - 0.6 * pixels[4 * i + 2]) / 255
    shares[i] = Math.round(255 * MathUtils.smoothstep(yellow, 0.08, 0.9))
  }
  return shares
}

/**
 * Lights of the world's towns: a picture of it says how many there are, noise where they stand in each of its texels,
 * down to a lane.
 *
 * Needs the attributes `globe`, coordinates in the picture, and `detail`, periods of the noise.
 *
 * @param url - Directory of the picture.
 */
export async function createCityLights(url: string, noise: DataTexture): Promise<CityLights> {
  const picture = townsOf(await new ImageLoader().loadAsync(`${url}earth-night.jpg`))
  picture.anisotropy = 8
  const scale = uniform(1e-4)
  const towns = texture(picture, attribute<'vec2'>('globe', 'vec2')).r
  const detail = attribute<'vec2'>('detail', 'vec2')
  // Mipmaps level out to a half what is too fine to see: then the factor is 1.
  const clumps = (periods: number, contrast: number): Node<'float'> =>
    texture(noise, detail.mul(periods)).r.sub(0.5).mul(contrast).add(1).clamp(0, 5)
  const lanes = clumps(9, 6).mul(clumps(83, 9)).mul(clumps(611, 12))
  const color = vec3(1, 0.72, 0.4)
  const emission = color.mul(towns.mul(lanes).mul(float(BRIGHTEST))).mul(scale)
  return { scale, emission, dispose: () => picture.dispose() }
}
