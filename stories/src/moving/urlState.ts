/** Time between two looks at what is to be kept [ms]: browsers refuse more than a few changes a second. */
const INTERVAL = 500

/** The page's window: that around a frame, if it may be seen from here. */
function pageWindow(): Window {
  try {
    // Throws for a page of another origin.
    if (window.top !== null && window.top.location.href !== '') return window.top
  } catch {}
  return window
}

/** Parameters of Storybook, which it adds at the end of an address, behind a `#` as well. */
const STORYBOOK = ['args', 'globals']

/** Parts of an address behind its `#`, encoded: `#view=1,2,3&hour=7`. */
function partsOf({ location }: Window): Map<string, string> {
  const parts = location.hash.replace(/^#/, '').split('&')
  const pairs = parts.filter(part => part.includes('=')).map(part => part.split('=', 2))
  return new Map(pairs.map(([key, value]) => [key, value]))
}

function decode(text: string): string {
  try {
    return decodeURIComponent(text)
  } catch {
    return '' // a broken escape
  }
}

/** Commas stay readable: no browser minds them there. */
const encode = (text: string): string => encodeURIComponent(text).replaceAll('%2C', ',')

export interface KeepOptions {
  /** Takes what the address has at once. Default true. */
  restores?: boolean
  /** Default the page, with Storybook around a story. */
  page?: Window
}

/**
 * Keeps something in the page's address, so that a link brings it back.
 *
 * The address stays as it is until that something changes; a link put into the open page is followed.
 *
 * @param key - Name in the address, letters alone.
 * @param ask - Answers with the present value; undefined leaves the address alone.
 * @param write - Takes a value from the address, which may be any text.
 * @returns Function that ends it.
 */
export function keepInUrl(
  key: string,
  ask: () => string | undefined,
  write: (value: string) => void,
  { restores = true, page = pageWindow() }: KeepOptions = {}
): () => void {
  const restore = (): void => {
    const value = partsOf(page).get(key)
    if (value !== undefined) write(decode(value))
  }
  const read = (): string | undefined => {
    const value = ask()
    return value === undefined ? undefined : encode(value)
  }
  const first = read()
  if (restores) restore()

  const keep = (): void => {
    const value = read()
    const parts = partsOf(page)
    const kept = parts.get(key)
    const isKept = value === undefined || value === kept || (kept === undefined && value === first)
    const misplaced = STORYBOOK.filter(name => parts.has(name))
    if (isKept && misplaced.length === 0) return
    if (!isKept) parts.set(key, value)
    const { pathname, search } = page.location
    const moved = misplaced.map(name => `&${name}=${parts.get(name)}`).join('')
    const hash = [...parts]
      .filter(([name]) => !misplaced.includes(name))
      .map(part => part.join('='))
    const url = `${pathname}${search}${moved}#${hash.join('&')}`
    // Storybook keeps its own state with the entry.
    page.history.replaceState(page.history.state, '', url)
  }
  const timer = setInterval(keep, INTERVAL)
  page.addEventListener('hashchange', restore)
  return () => {
    clearInterval(timer)
    page.removeEventListener('hashchange', restore)
  }
}
