const STORE = 'texels'

/** Bytes of a texture, top row first. */
export type Texels = Uint8Array<ArrayBuffer>

const _kept = new Map<string, Texels>()

/** Bytes kept by a name; undefined if there are none. */
export const keptTexels = (key: string): Texels | undefined => _kept.get(key)

/** Keeps bytes by a name, for this page and those to come. */
export async function keepTexels(key: string, parts: Texels[]): Promise<void> {
  const blob = new Blob(parts)
  _kept.set(key, new Uint8Array(await blob.arrayBuffer()))
  await (await caches.open(STORE)).put(`/${key}`, new Response(blob))
}

/** Fetches what other pages of the browser have kept. */
export async function loadTexels(): Promise<void> {
  const store = await caches.open(STORE)
  for (const { url } of await store.keys()) {
    const key = new URL(url).pathname.slice(1)
    if (_kept.has(key)) continue
    const response = await store.match(url)
    const texels = await response?.arrayBuffer()
    if (texels) _kept.set(key, new Uint8Array(texels))
  }
}
