/** Time between frames [ms]: shorter than a display's, so that tests that go through many wait little. */
const INTERVAL = 5

/**
 * Has `requestAnimationFrame` of this page call back by a timer. The browser then composes no frame of its own
 * for each, in which a software renderer would draw the page again beside the tests' pictures.
 */
export function requestOffscreenFrames(): void {
  let requests = new Map<number, FrameRequestCallback>()
  /** Requests of the frame that is being called back. */
  let current: typeof requests = new Map()
  let isTimed = false
  let count = 0

  const callBack = (): void => {
    isTimed = false
    current = requests
    requests = new Map()
    const time = performance.now()
    // Those that one of them cancels are left out, as a browser does.
    for (const request of current.values()) {
      try {
        request(time)
      } catch (error) {
        reportError(error)
      }
    }
  }

  globalThis.requestAnimationFrame = request => {
    if (!isTimed) setTimeout(callBack, INTERVAL)
    isTimed = true
    requests.set(++count, request)
    return count
  }
  globalThis.cancelAnimationFrame = handle => {
    requests.delete(handle)
    current.delete(handle)
  }
}
