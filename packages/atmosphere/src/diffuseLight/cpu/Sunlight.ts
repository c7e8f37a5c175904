import type { AtmosphereParameters } from '../../parameters/AtmosphereParameters'
import { distanceToTop } from '../../air/cpu/boundary'
import { interpolate } from '../../math/cpu/interpolate'
import { discTransmittance, visibleDisc } from '../../transmittance/cpu/transmittance'

/** Part of the sun's light that arrives at a point, tabulated: marches ask millions of times. */
export class Sunlight {
  static readonly #columns = 256
  static readonly #rows = 64
  readonly #depth: Float64Array
  readonly #p: AtmosphereParameters
  readonly #chord: number

  constructor(p: AtmosphereParameters) {
    const [columns, rows] = [Sunlight.#columns, Sunlight.#rows]
    this.#p = p
    this.#chord = Math.sqrt(p.topRadius ** 2 - p.bottomRadius ** 2)
    this.#depth = new Float64Array(4 * columns * rows)
    for (let row = 0; row < rows; row++) {
      const horizon = (this.#chord * row) / (rows - 1)
      const radius = Math.hypot(horizon, p.bottomRadius)
      const shortest = p.topRadius - radius
      for (let column = 0; column < columns; column++) {
        const longest = horizon + this.#chord
        const distance = shortest + ((longest - shortest) * column) / (columns - 1)
        const cosine = (this.#chord ** 2 - horizon ** 2 - distance ** 2) / (2 * radius * distance)
        const cosView = distance > 1 ? Math.min(Math.max(cosine, -1), 1) : 1
        // Thick air's transmittance underflows, but a depth must be finite.
        const depth = discTransmittance(p, radius, cosView).map(
          value => -Math.log(Math.max(value, 1e-300))
        )
        this.#depth.set(depth, 4 * (row * columns + column))
      }
    }
  }

  transmittance(radius: number, cosLight: number, target: Float64Array): void {
    const visible = visibleDisc(this.#p, radius, cosLight)
    if (visible === 0) {
      target.fill(0)
      return
    }
    const { bottomRadius, topRadius } = this.#p
    const horizon = Math.sqrt(Math.max(radius ** 2 - bottomRadius ** 2, 0))
    const distance = distanceToTop(radius, Math.max(cosLight, -horizon / radius), topRadius)
    const shortest = topRadius - radius
    const x = (distance - shortest) / Math.max(horizon + this.#chord - shortest, 1)
    const [columns, rows] = [Sunlight.#columns, Sunlight.#rows]
    const y = (horizon / this.#chord) * (rows - 1)
    interpolate(this.#depth, columns, rows, 4, x * (columns - 1), y, target)
    for (let i = 0; i < 4; i++) target[i] = visible * Math.exp(-target[i])
  }
}
