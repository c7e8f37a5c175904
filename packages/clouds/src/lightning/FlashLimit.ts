/** Shortest time between two rises of light: three a second (WCAG 2.2, success criterion 2.3.1) [s]. */
const SHORTEST = 1 / 3
/** Time in which limited light falls to 1/e [s]: strokes that follow do not rise above it. */
const FALL = 0.35

/**
 * Light that keeps to a limit, for people whom flashes harm: at most three rises in any second, none above a cap. What comes sooner is
 * taken in by the slow fall of the flash before.
 */
export class FlashLimit {
  #power = 0
  #sinceRise = Infinity

  /**
   * Advances in time.
   *
   * @param power - Light that there would be without a limit [lm].
   * @param cap - Greatest light [lm].
   * @param elapsed - Time since the last call [s].
   * @returns Light [lm].
   */
  step(power: number, cap: number, elapsed: number): number {
    this.#sinceRise += elapsed
    const left = this.#power * Math.exp(-elapsed / FALL)
    const wanted = Math.min(power, cap)
    const mayRise = this.#sinceRise >= SHORTEST
    if (wanted > left && mayRise) this.#sinceRise = 0
    this.#power = wanted > left && mayRise ? wanted : left
    // As good as dark.
    if (this.#power < 1e-4 * cap) this.#power = 0
    return this.#power
  }
}
