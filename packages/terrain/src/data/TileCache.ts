/** Values by key within a budget of bytes: those that were not used for the longest time go first. */
export class TileCache<T> {
  #bytes = 0
  /** In the order of their last use. */
  readonly #entries = new Map<number, { readonly value: T; readonly bytes: number }>()

  /**
   * @param budget - Most bytes that are kept.
   * @param isKept - True for keys that never go.
   */
  constructor(
    readonly budget: number,
    readonly isKept: (key: number) => boolean = () => false
  ) {}

  /** Bytes of all values. */
  get bytes(): number {
    return this.#bytes
  }

  /** Number of values. */
  get size(): number {
    return this.#entries.size
  }

  /** A value, used now; undefined if there is none. */
  get(key: number): T | undefined {
    const entry = this.#entries.get(key)
    if (entry === undefined) return undefined
    this.#entries.delete(key)
    this.#entries.set(key, entry)
    return entry.value
  }

  /** A value, without counting as use. */
  peek(key: number): T | undefined {
    return this.#entries.get(key)?.value
  }

  /** Keeps a value, and lets others go if there is no room. */
  set(key: number, value: T, bytes: number): void {
    this.delete(key)
    this.#entries.set(key, { value, bytes })
    this.#bytes += bytes
    for (const oldest of this.#entries.keys()) {
      if (this.#bytes <= this.budget || this.#entries.size === 1) break
      if (oldest !== key && !this.isKept(oldest)) this.delete(oldest)
    }
  }

  delete(key: number): void {
    const entry = this.#entries.get(key)
    if (entry === undefined) return
    this.#entries.delete(key)
    this.#bytes -= entry.bytes
  }

  clear(): void {
    this.#entries.clear()
    this.#bytes = 0
  }
}
