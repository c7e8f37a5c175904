import { fail } from '@welkin/geo'
import { HeightTiles, heightTile, type HeightTilesOptions } from './HeightTiles'
import { answerOf } from './loadPixels'
import { rasterizeMesh, type QuantizedMesh } from './rasterizeMesh'
import type { TileUrl } from './tileUrl'

/** Options of {@link QuantizedMeshTiles}. */
export interface QuantizedMeshTilesOptions extends Omit<HeightTilesOptions, 'loadPixels'> {
  /** Heights along an edge of the grid that a tile's triangles become, default 64. */
  size?: number
  /**
   * Loads the bytes of a tile, by default with `fetch`, for instance to send a key along. Null means that the tile does not exist, as do HTTP statuses
   * 204, 400, 403, 404 and 410 by default; an error, that it may be tried again.
   */
  loadTile?: (url: string, signal: AbortSignal) => Promise<ArrayBuffer | null>
}

const TYPES = 'application/vnd.quantized-mesh,application/octet-stream;q=0.9'

async function fetchTile(url: string, signal: AbortSignal): Promise<ArrayBuffer | null> {
  return (await answerOf(url, signal, { Accept: TYPES }))?.arrayBuffer() ?? null
}

/**
 * Heights in tiles of quantised meshes, of longitude and latitude with two tiles at level 0. A tile's triangles become a grid of
 * heights; what has none, or is corrupt, shows the coarser tile.
 *
 * ```ts
 * const loader = new QuantizedMeshLoaderBase() // of 3d-tiles-renderer/core/plugins
 * const heights = new QuantizedMeshTiles(
 *   'https://example.org/terrain/{z}/{x}/{-y}.terrain', // rows from the south
 *   buffer => loader.parse(buffer),
 *   { maxZoom: 13, attribution: 'Who measured the heights' }
 * )
 * scene.add(new Terrain(atmosphere, heights))
 * ```
 *
 * @see "Quantized Mesh 1.0", https://github.com/CesiumGS/quantized-mesh
 */
export class QuantizedMeshTiles extends HeightTiles {
  /**
   * @param url - Template as of `tileUrl`, or a function.
   * @param parse - Mesh of a tile's bytes; if it throws, the tile is taken for corrupt.
   * @throws If the template lacks a name, `parse` is no function, or an option is unknown or out of its range.
   */
  constructor(
    url: string | TileUrl,
    parse: (buffer: ArrayBuffer) => QuantizedMesh,
    options: QuantizedMeshTilesOptions = {}
  ) {
    const where = 'QuantizedMeshTiles'
    const { loadTile = fetchTile, size = 64, ...rest } = options
    if (typeof parse !== 'function') fail(where, 'parse must be a function', parse)
    if (typeof loadTile !== 'function') fail(where, 'loadTile must be a function', loadTile)
    if ('loadPixels' in rest) fail(where, 'loadPixels must be loadTile')
    super(
      where,
      url,
      all => async (tileUrl, signal) => {
        const buffer = await loadTile(tileUrl, signal)
        if (buffer === null || signal.aborted) return null
        try {
          return heightTile(rasterizeMesh(parse(buffer), all.size), all)
        } catch {
          return null
        }
      },
      { ...rest, size },
      false
    )
  }
}
