import { RepeatWrapping, SRGBColorSpace, TextureLoader } from 'three'
import type { Texture } from 'three'

/** The Earth's colours, water and night lights. */
export async function earthPictures(): Promise<
  Record<'surface' | 'water' | 'nightLights', Texture>
> {
  const folder = new URL('world-data/earth/', document.baseURI).href
  const load = async (name: string, isColor: boolean): Promise<Texture> => {
    const picture = await new TextureLoader().loadAsync(folder + name)
    if (isColor) picture.colorSpace = SRGBColorSpace
    picture.wrapS = RepeatWrapping
    picture.anisotropy = 8
    return picture
  }
  const [surface, water, nightLights] = await Promise.all([
    load('earth-blue-marble.jpg', true),
    load('earth-water.png', false),
    load('earth-night.jpg', true)
  ])
  return { surface, water, nightLights }
}
