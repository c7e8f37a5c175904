import { HeightTiles, readerOfPictures, type HeightTilesOptions } from './HeightTiles'
import type { TileUrl } from './tileUrl'

/**
 * Heights in tiles of the Terrarium format: red × 256 + green + blue / 256 − 32,768 m.
 *
 * ```ts
 * const heights = new TerrariumTiles('https://example.org/terrarium/{z}/{x}/{y}.png', {
 *   attribution: 'Mapzen, USGS'
 * })
 * scene.add(new Terrain(atmosphere, heights))
 * ```
 *
 * @see "Terrain Tiles", https://github.com/tilezen/joerd/blob/master/docs/formats.md
 */
export class TerrariumTiles extends HeightTiles {
  /**
   * @param url - Template as of `tileUrl`, or a function.
   * @throws If the template lacks a name, or an option is unknown or out of its range.
   */
  constructor(url: string | TileUrl, options: HeightTilesOptions = {}) {
    super(
      'TerrariumTiles',
      url,
      readerOfPictures((red, green, blue) => red * 256 + green + blue / 256 - 32_768),
      options
    )
  }
}

/**
 * Heights in tiles of the Terrain-RGB format: (red × 65,536 + green × 256 + blue) / 10 − 10,000 m. Black, −10,000 m, says that
 * there is none: `lowest` is −9,999 by default.
 *
 * @see "Access elevation data", https://docs.mapbox.com/data/tilesets/guides/access-elevation-data/
 */
export class TerrainRGBTiles extends HeightTiles {
  /**
   * @param url - Template as of `tileUrl`, or a function.
   * @throws If the template lacks a name, or an option is unknown or out of its range.
   */
  constructor(url: string | TileUrl, options: HeightTilesOptions = {}) {
    const decode = (red: number, green: number, blue: number): number =>
      (red * 65_536 + green * 256 + blue) / 10 - 10_000
    super('TerrainRGBTiles', url, readerOfPictures(decode), {
      ...options,
      lowest: options.lowest ?? -9999
    })
  }
}
