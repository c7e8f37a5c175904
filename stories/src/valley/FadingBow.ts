import type { Raindrops, ScatteringAngles, ScatteringPhase } from '@welkin/atmosphere'
import { mix, uniform, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'

/** Lobes of rain without bows: asymmetry and share of each. The other half is diffracted straight on. */
const LOBES = [
  [0.88, 0.465],
  [-0.1, 0.035]
] as const

/** Henyey–Greenstein phase function of an asymmetry [1/sr]. */
function lobe(asymmetry: number, cosine: Node<'float'>): Node<'float'> {
  const square = asymmetry ** 2
  return cosine
    .mul(-2 * asymmetry)
    .add(1 + square)
    .pow(-1.5)
    .mul((1 - square) / (4 * Math.PI))
}

/** Rain whose bows come and go while it is drawn; without them it scatters as much light, smoothly. */
export class FadingBow implements ScatteringPhase {
  readonly #drops: Raindrops
  readonly #strength = uniform(1)
  #changes = 0

  /** @param drops - Rain with its bows; owned. */
  constructor(drops: Raindrops) {
    this.#drops = drops
  }

  /** Strength of the bows, in [0, 1]; 1 is physical. */
  get strength(): number {
    return this.#strength.value
  }

  set strength(value: number) {
    if (value === this.#strength.value) return
    this.#strength.value = value
    this.#changes++
  }

  get asymmetry(): number {
    return this.#drops.asymmetry
  }

  get version(): number {
    return this.#drops.version + this.#changes
  }

  phase(angles: ScatteringAngles): Node<'vec4'> {
    const shares = LOBES.map(([g, share]) => lobe(g, angles.cosViewLight).mul(share))
    const smooth = vec4(shares[0].add(shares[1]))
    return mix(smooth, this.#drops.phase(angles), this.#strength)
  }

  dispose(): void {
    this.#drops.dispose()
  }
}
