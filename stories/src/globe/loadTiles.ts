import type { TilesRenderer } from '3d-tiles-renderer'

interface LoadState {
  root: object | null
  isLoading: boolean
  loadProgress: number
  stats: { queued: number; downloading: number; parsing: number }
}

/** Passes without work before a view counts as loaded: a tile that has just arrived asks for its children in the next. */
const QUIET_PASSES = 4

function isIdle(tiles: TilesRenderer): boolean {
  const { root, isLoading, stats } = tiles as unknown as LoadState
  return root !== null && !isLoading && stats.queued + stats.downloading + stats.parsing === 0
}

export function tilesProgress(tilesets: TilesRenderer[]): number {
  const states = tilesets as unknown as LoadState[]
  return (
    states.reduce((sum, { root, loadProgress }) => sum + (root === null ? 0 : loadProgress), 0) /
    states.length
  )
}

/**
 * Settles when every tile of the present view is loaded.
 *
 * @param update - Updates the tilesets; called until they have nothing left to do.
 * @param isCancelled - Ends the wait when true.
 * @throws Error if a tileset cannot be loaded.
 */
export async function loadTiles(
  tilesets: TilesRenderer[],
  update: () => void,
  isCancelled: () => boolean
): Promise<void> {
  let failure: Error | undefined
  const onError = ({
    tile,
    error,
    url
  }: {
    tile: object | null
    error: Error
    url: string | URL
  }): void => {
    if (tile === null) {
      failure = new Error(`loadTiles: ${String(url)} could not be loaded: ${error.message}`)
    }
  }
  tilesets.forEach(tiles => tiles.addEventListener('load-error', onError))
  try {
    for (let quiet = 0; quiet < QUIET_PASSES;) {
      update()
      await new Promise(resolve => setTimeout(resolve, 4))
      if (isCancelled()) {
        return
      }
      if (failure !== undefined) {
        throw failure
      }
      quiet = tilesets.every(isIdle) ? quiet + 1 : 0
    }
  } finally {
    tilesets.forEach(tiles => tiles.removeEventListener('load-error', onError))
  }
}
