import type { Tile } from '../tiles/Tile'

/** Selections after which what nobody asked for again is not waited for. */
const WAIT_FOR = 60

/** Time after which what failed is asked for again [ms]. */
const RETRY_AFTER = 5000

/** Most loads at once: as many as pages in a frame until the first picture is full. */
const MOST_LOADS = 32

/** Data of a page that was asked for. */
export interface PageLoad<T> {
  readonly abort: AbortController
  /** Selection that first asked for it. */
  readonly first: number
  /** Selection that last asked for it. */
  wanted: number
  state: 'loading' | 'there' | 'failed' | 'due'
  /** Data, once they are there. */
  value?: T
}

/** Data of pages that may take time to arrive. What nobody wants any more is given up, and what failed is asked for again later. */
export class PageLoads<T> {
  readonly #loads = new Map<Tile, PageLoad<T>>()
  readonly #onChange: () => void

  /** @param onChange - Called when data have come later than they were asked for, have failed, or are to be asked for again. */
  constructor(onChange: () => void) {
    this.#onChange = onChange
  }

  /** Number of loads that have not failed. */
  get open(): number {
    return [...this.#loads.values()].filter(({ state }) => state === 'loading' || state === 'there')
      .length
  }

  /** True if there are as many loads as there may be at once. */
  get isFull(): boolean {
    return this.open >= MOST_LOADS
  }

  /** Tiles with loads. */
  get tiles(): Tile[] {
    return [...this.#loads.keys()]
  }

  /** Load of a tile, which is still wanted; undefined if there is none, or it failed some time ago. */
  get(tile: Tile, selection: number): PageLoad<T> | undefined {
    const load = this.#loads.get(tile)
    if (load !== undefined) load.wanted = selection
    return load?.state === 'due' ? undefined : load
  }

  /** Asks for a tile's data. */
  begin(
    tile: Tile,
    selection: number,
    ask: (signal: AbortSignal) => T | PromiseLike<T>
  ): PageLoad<T> {
    const abort = new AbortController()
    const load: PageLoad<T> = { abort, first: selection, wanted: selection, state: 'loading' }
    this.#loads.set(tile, load)
    const fail = (): void => {
      load.state = abort.signal.aborted ? 'due' : 'failed'
      if (load.state === 'due') return
      setTimeout(() => {
        load.state = 'due'
        if (this.#loads.get(tile) === load) this.#onChange()
      }, RETRY_AFTER)
    }
    const finish = (value: T): void => {
      load.state = 'there'
      load.value = value
    }
    try {
      const answer = ask(abort.signal)
      if (isPromise(answer)) void answer.then(finish, fail).then(this.#onChange)
      else finish(answer)
    } catch {
      fail()
    }
    return load
  }

  /** Forgets a load that has been made use of. */
  delete(tile: Tile): void {
    this.#loads.delete(tile)
  }

  /** Gives up what nobody waits for. A page that was drawn without it asks for it again when it is seen. */
  abandon(selection: number): void {
    for (const [tile, { wanted, abort }] of this.#loads) {
      if (selection - wanted <= WAIT_FOR) continue
      abort.abort()
      if (tile.slot < 0) this.#loads.delete(tile)
    }
  }

  /** Gives up all. */
  clear(): void {
    for (const { abort } of this.#loads.values()) abort.abort()
    this.#loads.clear()
  }
}

const isPromise = <T>(answer: T | PromiseLike<T>): answer is PromiseLike<T> =>
  answer instanceof Promise
