import { RepeatWrapping, TextureLoader } from 'three'
import type { Texture } from 'three'

/** Cloud cover of the whole Earth, for `worldMap`. */
export async function cloudCover(): Promise<Texture> {
  const url = new URL('world-data/clouds/clouds.png', document.baseURI).href
  const cover = await new TextureLoader().loadAsync(url)
  cover.wrapS = RepeatWrapping
  // White clouds on nothing: the share that is covered is in alpha, and so goes to red.
  cover.premultiplyAlpha = true
  return cover
}
