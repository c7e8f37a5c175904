import { GridHeights } from '@welkin/terrain'

/** Description of the grid in `data/`. */
interface GridFile {
  readonly rows: number
  readonly columns: number
  readonly west: number
  readonly east: number
  readonly south: number
  readonly north: number
  readonly source: string
}

async function load(name: string): Promise<Response> {
  const url = new URL(`world-data/heights/${name}`, document.baseURI)
  const response = await fetch(url)
  if (!response.ok || response.body === null) throw new Error(`${url.href}: ${response.status}`)
  return response
}

/** Heights measured from space, 28 × 32 km of ridges in Tennessee; a plain about them. */
export async function loadGrid(): Promise<GridHeights> {
  const file = (await (await load('jacksboro-dem.json')).json()) as GridFile
  const packed = (await load('jacksboro-dem.i16.gz')).body!
  const bytes = new Response(packed.pipeThrough(new DecompressionStream('gzip'))).arrayBuffer()
  // #region grid
  const { columns: width, rows: height, west, east, south, north } = file
  const area = { width, height, west, east, south, north }
  const heights = new GridHeights(new Int16Array(await bytes), {
    ...area,
    outside: 300,
    fade: 6000,
    attribution: file.source
  })
  // #endregion
  return heights
}
