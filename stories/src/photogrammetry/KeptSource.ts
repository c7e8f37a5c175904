import { afterLast } from '../afterLast'
import { keepInUrl } from '../moving/urlState'
import type { TileSource } from './unlitTiles'

/** Name of the key among the story's arguments: Storybook leaves names with such a sign out of addresses, and takes none from them. */
export const KEY = 'key!'

/** Server of tiles, as the story's fields have it. */
export interface SourceArgs {
  /** URL of `TileSource`. */
  url: string
  /** Key of `TileSource`. */
  [KEY]: string
}

/** Time after the last keystroke until tiles are asked for [ms]. */
const TYPING = 500

/** True until a story has taken what the page was opened with. */
let isOpening = true

export interface KeptOptions {
  /** Takes the tileset that the page's address has. Default true for the first story of the page. */
  restores?: boolean
  /** Page with the address; default as of `keepInUrl`. */
  page?: Window
  /** Default that of the tab. */
  storage?: Pick<Storage, 'getItem' | 'setItem' | 'removeItem'>
}

/** Name under which a key is kept: one for each server, so that a link to another one is not given it. */
export function keyName(url: string): string {
  const isGoogle = url === '' || url.startsWith('https://tile.googleapis.com/')
  const server = isGoogle ? 'google' : url.startsWith('ion:') ? 'ion' : originOf(url)
  return `welkin key of ${server}`
}

function originOf(url: string): string {
  try {
    return new URL(url).origin
  } catch {
    return url
  }
}

/** Server of tiles that a story shows: the address keeps its URL, the tab its key, which no link has. */
export class KeptSource {
  /** URL and key now. */
  readonly current: { -readonly [K in keyof TileSource]: TileSource[K] }
  readonly #storage: NonNullable<KeptOptions['storage']>
  readonly #settled
  /** Arguments that the story has. */
  #args: SourceArgs
  #isShown = true
  readonly #forget: () => void

  /** @param ask - Asks for the tiles of {@link current}: once the last change of it was a while ago. */
  constructor(args: SourceArgs, ask: () => void, options: KeptOptions = {}) {
    const { restores = isOpening, page, storage = sessionStorage } = options
    isOpening = false
    this.#storage = storage
    this.#args = { url: args.url, [KEY]: args[KEY] }
    this.current = { url: args.url, key: args[KEY] }
    this.#settled = afterLast(TYPING, () => {
      this.#keepKey()
      ask()
    })
    this.#fillIn(args.url, args[KEY])
    this.#forget = keepInUrl(
      'tileset',
      () => this.current.url,
      url => {
        if (url === this.current.url) return
        this.#fillIn(url)
        this.#settled.ask()
      },
      { restores, ...(page && { page }) }
    )
    this.#settled.cancel() // whoever makes it asks at once
  }

  /** Goes to a server, with its key if it has none given. */
  #fillIn(url: string, given = ''): void {
    const key = given || this.#keptKey(url)
    Object.assign(this.current, { url, key })
    this.#isShown = url === this.#args.url && key === this.#args[KEY]
  }

  // Browsers that keep nothing throw.
  #keptKey(url: string): string {
    try {
      return this.#storage.getItem(keyName(url)) ?? ''
    } catch {
      return ''
    }
  }

  #keepKey(): void {
    const { url, key } = this.current
    try {
      if (key === '') this.#storage.removeItem(keyName(url))
      else this.#storage.setItem(keyName(url), key)
    } catch {}
  }

  /**
   * Takes the story's arguments: those that have changed.
   *
   * @returns True if tiles will be asked for.
   */
  take({ url, [KEY]: key }: SourceArgs): boolean {
    const last = this.#args
    this.#args = { url, [KEY]: key }
    const before = { ...this.current }
    const isNewUrl = url !== last.url
    const to = isNewUrl ? url : before.url
    if (key !== last[KEY]) Object.assign(this.current, { url: to, key })
    else if (isNewUrl && keyName(to) !== keyName(before.url)) this.#fillIn(to)
    else this.current.url = to
    const isOther = before.url !== to || before.key !== this.current.key
    if (isOther) this.#settled.ask()
    return isOther
  }

  /** Has the story's fields show what address and tab had. */
  show(onArgs: ((changes: SourceArgs) => void) | undefined): void {
    if (this.#isShown || onArgs === undefined) return
    this.#isShown = true
    onArgs({ url: this.current.url, [KEY]: this.current.key })
  }

  dispose(): void {
    this.#settled.cancel()
    this.#forget()
  }
}
