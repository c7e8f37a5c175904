import { abortReason } from './abortReason'

/** Settings of {@link TileRequests}. */
export interface TileRequestsOptions {
  /** Most loads at once. */
  readonly concurrency: number
  /** Times that a failed load is tried again. */
  readonly retries: number
  /** Wait before the first of these, doubled each time [s]. */
  readonly backOff: number
}

/** Someone who waits for a value. */
interface Waiter<T> {
  resolve(value: T): void
  reject(reason: unknown): void
}

interface Request<T> {
  readonly key: number
  priority: number
  /** Number of the call that last asked for it. */
  order: number
  attempts: number
  state: 'waiting' | 'loading' | 'resting'
  readonly abort: AbortController
  readonly waiters: Set<Waiter<T>>
  timer?: ReturnType<typeof setTimeout>
}

/**
 * Queue of loads: the lowest priority number first, and of equal ones the newest, so that a fast flight gets what it sees
 * now. A key is loaded once for all who wait for it, and given up when the last of them does.
 */
export class TileRequests<T> {
  readonly #load: (key: number, signal: AbortSignal) => Promise<T>
  readonly #options: TileRequestsOptions
  readonly #requests = new Map<number, Request<T>>()
  #loading = 0
  #calls = 0

  /** @param load - Called again after a failure, unless what it throws is a `PermanentFailure`. */
  constructor(
    load: (key: number, signal: AbortSignal) => Promise<T>,
    options: TileRequestsOptions
  ) {
    this.#load = load
    this.#options = options
  }

  /** Number of keys that somebody waits for. */
  get size(): number {
    return this.#requests.size
  }

  /**
   * Loads a key's value.
   *
   * @param priority - The lower, the sooner.
   * @param signal - Aborted when the caller no longer needs it; then the promise is rejected.
   */
  get(key: number, priority: number, signal: AbortSignal): Promise<T> {
    return new Promise((resolve, reject) => {
      if (signal.aborted) {
        reject(abortReason(signal))
        return
      }
      // A page waits for many tiles with one signal, which Node would warn of.
      const given = AbortSignal.any([signal])
      const request = this.#requestOf(key)
      request.priority = Math.min(request.priority, priority)
      request.order = ++this.#calls
      const forget = (): void => {
        request.waiters.delete(waiter)
        given.removeEventListener('abort', leave)
      }
      const leave = (): void => {
        forget()
        reject(abortReason(signal))
        if (request.waiters.size === 0) this.#giveUp(request)
      }
      const waiter: Waiter<T> = {
        resolve(value) {
          forget()
          resolve(value)
        },
        reject(reason) {
          forget()
          reject(reason)
        }
      }
      request.waiters.add(waiter)
      given.addEventListener('abort', leave)
      this.#fill()
    })
  }

  /** Gives up everything: all who wait are refused. */
  clear(): void {
    for (const request of this.#requests.values()) {
      this.#giveUp(request)
      for (const waiter of request.waiters) waiter.reject(abortReason(request.abort.signal))
    }
  }

  #requestOf(key: number): Request<T> {
    const known = this.#requests.get(key)
    if (known !== undefined) return known
    const made: Request<T> = {
      key,
      priority: Infinity,
      order: 0,
      attempts: 0,
      state: 'waiting',
      abort: new AbortController(),
      waiters: new Set()
    }
    this.#requests.set(key, made)
    return made
  }

  #giveUp(request: Request<T>): void {
    clearTimeout(request.timer)
    if (this.#requests.get(request.key) === request) this.#requests.delete(request.key)
    request.abort.abort()
  }

  /** Begins loads while there is room. */
  #fill(): void {
    while (this.#loading < this.#options.concurrency) {
      let next: Request<T> | undefined
      for (const request of this.#requests.values()) {
        if (request.state !== 'waiting') continue
        const isSooner =
          next === undefined ||
          request.priority < next.priority ||
          (request.priority === next.priority && request.order > next.order)
        if (isSooner) next = request
      }
      if (next === undefined) return
      void this.#run(next)
    }
  }

  async #run(request: Request<T>): Promise<void> {
    request.state = 'loading'
    request.attempts++
    this.#loading++
    let settle: (waiter: Waiter<T>) => void
    let isOver = true
    try {
      const value = await this.#load(request.key, request.abort.signal)
      settle = waiter => waiter.resolve(value)
    } catch (error) {
      settle = waiter => waiter.reject(error)
      isOver =
        error instanceof PermanentFailure ||
        request.abort.signal.aborted ||
        request.attempts > this.#options.retries
    }
    this.#loading--
    if (isOver) {
      if (this.#requests.get(request.key) === request) this.#requests.delete(request.key)
      for (const waiter of request.waiters) settle(waiter)
    } else {
      request.state = 'resting'
      const wait = this.#options.backOff * 2 ** (request.attempts - 1)
      request.timer = setTimeout(() => {
        request.state = 'waiting'
        this.#fill()
      }, 1000 * wait)
    }
    this.#fill()
  }
}

/** Failure that is final, such as a tile that does not exist: it is not tried again. */
export class PermanentFailure extends Error {
  override readonly name = 'PermanentFailure'
}
