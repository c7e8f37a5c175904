import type { PageRequest } from './PageSource'

/** Colours of a page. */
export interface PageImage {
  /** RGBA of 8 bits, sRGB, row by row, four times `side`² of them; alpha 0 where there is no picture. */
  readonly colors: Uint8ClampedArray
  /** True if no better ones can be loaded. */
  readonly isWhole: boolean
}

/** Imagery of a planet's ground that may take time to arrive. */
export interface PageImages {
  /** Line that names the data's source. */
  readonly attribution?: string

  /** Colours in memory now: coarse ones, or none, where finer ones have not arrived. */
  imageOf(request: PageRequest): PageImage

  /**
   * Loads what is missing of a page.
   *
   * @param signal - Aborted when nobody needs the page any more.
   * @returns Resolved when `imageOf` has better colours. If it is rejected, they are asked for again later.
   */
  loadImage(request: PageRequest, signal: AbortSignal): Promise<void>
}
