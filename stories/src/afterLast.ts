/** Something that is done once nobody has asked for it for a while. */
export interface AfterLast {
  readonly ask: () => void
  /** Forgets what was asked for. */
  readonly cancel: () => void
}

/**
 * Waits for the last of several changes.
 *
 * @param milliseconds - Time after the last call of `ask` [ms].
 */
export function afterLast(milliseconds: number, act: () => void): AfterLast {
  let timer: ReturnType<typeof setTimeout> | undefined
  return {
    ask() {
      clearTimeout(timer)
      timer = setTimeout(act, milliseconds)
    },
    cancel() {
      clearTimeout(timer)
    }
  }
}
