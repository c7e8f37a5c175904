import type { Tile } from '../tiles/Tile'
import { ImageLoader, type LoadedImages, type PageImage } from './ImageLoader'
import type { PageRequest } from './PageSource'

/** Imagery of a planet's ground that may take time to arrive. */
export abstract class PageImages implements LoadedImages {
  /** Line that names the data's source. */
  readonly attribution?: string

  /** Colours in memory now: coarse ones, or none, where finer ones have not arrived. */
  abstract imageOf(request: PageRequest): PageImage

  /**
   * Loads what is missing of a page.
   *
   * @param signal - Aborted when nobody needs the page any more.
   * @returns Resolved when `imageOf` has better colours. If it is rejected, they are asked for again later.
   */
  abstract loadImage(request: PageRequest, signal: AbortSignal): Promise<void>

  /** Makes the loader of pictures for a terrain's pages. @internal */
  makeLoader(requestOf: (tile: Tile) => PageRequest, onChange: () => void): ImageLoader {
    return new ImageLoader(this, requestOf, onChange)
  }
}
