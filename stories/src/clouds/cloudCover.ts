import { ImageLoader, RedFormat, RepeatWrapping, type DataTexture } from 'three'
import { mipmapped } from '../mipmapped'
import { pixelsOf } from '../pixels'

/** Cloud cover of the whole Earth, for `cloudWorldMap`: one channel, the share of the sky that is covered. */
export async function cloudCover(): Promise<DataTexture> {
  const url = new URL('world-data/clouds/clouds.png', document.baseURI).href
  const picture = await new ImageLoader().loadAsync(url)
  const { width, height } = picture
  const data = pixelsOf(picture, 'cloudCover')
  const cover = new Uint8Array(width * height)
  // White clouds on nothing: what they cover is in alpha.
  for (let i = 0; i < cover.length; i++) cover[i] = data[4 * i + 3]
  const texture = mipmapped(cover, width, height, RedFormat)
  texture.wrapS = RepeatWrapping
  return texture
}
