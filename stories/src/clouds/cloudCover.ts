import { ImageLoader, RedFormat, RepeatWrapping, type DataTexture } from 'three'
import { mipmapped } from '../mipmapped'

/** Cloud cover of the whole Earth, for `cloudWorldMap`: one channel, the share of the sky that is covered. */
export async function cloudCover(): Promise<DataTexture> {
  const url = new URL('world-data/clouds/clouds.png', document.baseURI).href
  const picture = await new ImageLoader().loadAsync(url)
  const { width, height } = picture
  const canvas = document.createElement('canvas')
  canvas.width = width
  canvas.height = height
  const context = canvas.getContext('2d', { willReadFrequently: true })
  if (context === null) throw new Error('cloudCover: there is no 2D canvas')
  // Rows of a texture go up.
  context.scale(1, -1)
  context.drawImage(picture, 0, -height)
  const { data } = context.getImageData(0, 0, width, height)
  const cover = new Uint8Array(width * height)
  // White clouds on nothing: what they cover is in alpha.
  for (let i = 0; i < cover.length; i++) cover[i] = data[4 * i + 3]
  const texture = mipmapped(cover, width, height, RedFormat)
  texture.wrapS = RepeatWrapping
  return texture
}
