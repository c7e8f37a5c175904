/** Numbers of a view that go over into those of the next. */
export type Blended = Readonly<Record<string, number>>

/** Perlin's smootherstep. */
const smoothed = (t: number): number => t ** 3 * (t * (t * 6 - 15) + 10)

/**
 * Change of a scene from one view to the next, while the camera flies: numbers blend, and what cannot blend, such as
 * clouds of another kind in another place, goes out and comes in.
 */
export class ViewChange<View, Numbers extends Blended> {
  #shown: View
  #next: View
  #from: Numbers
  #to: Numbers
  /** Part that was there when the change began. */
  #fromPart = 1
  #share = 1
  #seconds = 0

  constructor(view: View, numbers: Numbers) {
    this.#shown = this.#next = view
    this.#from = this.#to = numbers
  }

  /** View whose place and clouds are shown: the old one up to the middle of the change. */
  get shown(): View {
    return this.#shown
  }

  /** Part of these that is there, in [0, 1]: 0 in the middle of a change. */
  get part(): number {
    const way = 2 * smoothed(this.#share) - 1
    return way < 0 ? -way * this.#fromPart : way
  }

  /** Numbers on their way. */
  get numbers(): Numbers {
    const share = smoothed(this.#share)
    const blend = ([key, to]: [string, number]): [string, number] => {
      const from = this.#from[key]
      return [key, share === 1 ? to : from + (to - from) * share]
    }
    return Object.fromEntries(Object.entries(this.#to).map(blend)) as Numbers
  }

  /** Has other numbers, at once, or at the end of the change that is under way. */
  set(numbers: Numbers): void {
    this.#to = numbers
  }

  /**
   * Goes to a view.
   *
   * @param seconds - Time that it takes; 0 is there at once [s].
   */
  go(view: View, numbers: Numbers, seconds: number): void {
    this.#from = this.numbers
    this.#fromPart = this.part
    this.#to = numbers
    this.#next = view
    this.#seconds = seconds
    this.#share = seconds > 0 ? 0 : 1
    if (seconds === 0) this.#shown = view
  }

  /** @returns True while a change is under way, its last step included. */
  update(seconds: number): boolean {
    if (this.#share === 1) return false
    this.#share = Math.min(this.#share + seconds / this.#seconds, 1)
    if (this.#share >= 0.5) this.#shown = this.#next
    return true
  }
}
