import type { ParticleKind } from '../../../src/precipitation/ParticleKind'
import { numberBetween } from '../../../src/precipitation/cpu/sizes'

/** Width of a particle [m], by its diameter as water [mm]. */
export type WidthOf = (diameter: number) => number

/** Widths of snowflakes: ρ_s D³ = ρ_w D_m³ with ρ_s = 178 (D/mm)^−0.922, solved by bisection. */
export function flakeWidth(diameter: number): number {
  let [low, high] = [0, 1000]
  for (let i = 0; i < 100; i++) {
    const middle = (low + high) / 2
    const mass = 0.178 * middle ** -0.922 * middle ** 3
    if (mass < diameter ** 3) low = middle
    else high = middle
  }
  return low / 1000
}

const smooth = (from: number, to: number, value: number): number => {
  const t = Math.min(Math.max((value - from) / (to - from), 0), 1)
  return t * t * (3 - 2 * t)
}

/** Geometric extinction of a class of size [1/m]: Σ π/4 D², by sums over sizes. */
export function classExtinction(
  kind: ParticleKind,
  rate: number,
  index: number,
  widthOf: WidthOf
): number {
  const [from, to] = [kind.edges[index], kind.edges[index + 1]]
  const sizes = kind.sizes(rate)
  const step = (to - from) / 400
  let sum = 0
  for (let i = 0; i < 400; i++) {
    const at = from + i * step
    sum += numberBetween(sizes, at, at + step) * (Math.PI / 4) * widthOf(at + step / 2) ** 2
  }
  return sum
}

/** Optical depth of all that is drawn before a camera: each class up to where it fades. */
export function drawnDepth(kind: ParticleKind, rate: number, widthOf: WidthOf): number {
  return kind.reach.reduce((depth, reach, index) => {
    let way = 0
    const step = reach / 1000
    for (let r = step / 2; r < reach; r += step) {
      way += step * smooth(0.12, 0.35, r) * (1 - smooth(0.7, 1, r / reach))
    }
    return depth + way * classExtinction(kind, rate, index, widthOf)
  }, 0)
}
