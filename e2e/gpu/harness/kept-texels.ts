/** Path of the store on the server of the tests. */
const STORE = '/texels/'

/** Bytes of a texture, top row first. */
export type Texels = Uint8Array<ArrayBuffer>

const _kept = new Map<string, Texels>()
/** Files of the store that this page has read, or written. */
const _files = new Set<string>()

/** Bytes kept by a name; undefined if there are none. */
export const keptTexels = (key: string): Texels | undefined => _kept.get(key)

/** Keeps bytes by a name, for this page and all that come, of other browsers and runs, too. */
export async function keepTexels(key: string, parts: Texels[]): Promise<void> {
  const blob = new Blob(parts)
  _kept.set(key, new Uint8Array(await blob.arrayBuffer()))
  const file = crypto.randomUUID()
  _files.add(file)
  await fetch(STORE + file, { method: 'PUT', body: new Blob([`${key}\n`, blob]) })
}

/** Reads what has been kept since it was called last. */
export async function loadTexels(): Promise<void> {
  const files = (await (await fetch(STORE)).json()) as string[]
  for (const file of files.filter(name => !_files.has(name))) {
    _files.add(file)
    const bytes = new Uint8Array(await (await fetch(STORE + file)).arrayBuffer())
    const end = bytes.indexOf('\n'.charCodeAt(0))
    const key = new TextDecoder().decode(bytes.subarray(0, end))
    if (!_kept.has(key)) _kept.set(key, bytes.slice(end + 1))
  }
}
