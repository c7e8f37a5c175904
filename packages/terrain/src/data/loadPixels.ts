import { PermanentFailure } from './TileRequests'

/** Pixels of a picture: RGBA, 8 bits each, row by row from the top. */
export interface Pixels {
  /** Pixels of a row. */
  readonly width: number
  /** Number of rows. */
  readonly height: number
  /** Four numbers of 0 to 255 for each pixel. */
  readonly data: ArrayLike<number>
}

/**
 * HTTP statuses after which a tile is not asked for again. 403 is among them: storage that nobody may list gives it for
 * files that do not exist. 401 is not: a name or a key may come later.
 */
const GONE: ReadonlySet<number> = new Set([204, 400, 403, 404, 410])

/** Time after which a request has failed: servers that hang would hold up all others [ms]. */
const PATIENCE = 30_000

/**
 * Answer of a server; null where it says that there is nothing.
 *
 * @throws If the network or the server fails, takes longer than 30 s, or the signal is aborted.
 */
export async function answerOf(
  url: string,
  signal: AbortSignal,
  headers: Record<string, string> = {}
): Promise<Response | null> {
  const either = AbortSignal.any([signal, AbortSignal.timeout(PATIENCE)])
  const response = await fetch(url, { signal: either, headers })
  if (GONE.has(response.status)) return null
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`)
  return response
}

/**
 * Loads the pixels of a picture in a browser, as they stand in the file: no colour profile or alpha is applied to them.
 *
 * @returns Pixels, or null where there is no picture: the server says so, or it is corrupt.
 * @throws If the network or the server fails, takes longer than 30 s, or the signal is aborted.
 */
export async function loadPixels(url: string, signal: AbortSignal): Promise<Pixels | null> {
  const blob = await (await answerOf(url, signal))?.blob()
  if (blob === undefined) return null
  let bitmap: ImageBitmap
  try {
    bitmap = await createImageBitmap(blob, {
      colorSpaceConversion: 'none',
      premultiplyAlpha: 'none'
    })
  } catch {
    return null
  }
  const { width, height } = bitmap
  const context = new OffscreenCanvas(width, height).getContext('2d', {
    willReadFrequently: true
  })
  if (context === null) throw new PermanentFailure('no 2D canvas')
  context.drawImage(bitmap, 0, 0)
  bitmap.close()
  return context.getImageData(0, 0, width, height)
}
