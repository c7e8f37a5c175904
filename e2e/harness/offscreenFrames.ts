/** Time between frames [ms]: shorter than a display's, so that tests that go through many wait little. */
const INTERVAL = 5

/**
 * Has `requestAnimationFrame` of this page call back by a timer. The browser then composes no frame of its own
 * for each, in which a software renderer would draw the page again beside the tests' pictures.
 */
export function requestOffscreenFrames(): void {
  let requests = new Map<number, FrameRequestCallback>()
  let count = 0

  const callBack = (): void => {
    const current = requests
    requests = new Map()
    const time = performance.now()
    for (const request of current.values()) {
      try {
        request(time)
      } catch (error) {
        reportError(error)
      }
    }
  }

  globalThis.requestAnimationFrame = request => {
    if (requests.size === 0) setTimeout(callBack, INTERVAL)
    requests.set(++count, request)
    return count
  }
  globalThis.cancelAnimationFrame = handle => void requests.delete(handle)
}
