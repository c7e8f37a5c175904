import { gaussLegendre } from '@welkin/atmosphere'
import type { ScaledPhase } from './cloudPhase'
import { cholesky, factorize, symmetricEigen, type Matrix } from './matrices'

/** Streams per hemisphere: moments of the light are within 1e-4 of 24 streams for suns up to 85°. */
const STREAMS = 8

/** Normalised associated Legendre functions Λ_l^m(μ)/sin^m θ for l ≤ 2: polynomials. */
const polynomials: ((mu: number) => number)[][] = [
  [() => 1, mu => mu, mu => (3 * mu * mu - 1) / 2],
  [() => Math.SQRT1_2, mu => Math.sqrt(3 / 2) * mu],
  [() => Math.sqrt(3 / 8)]
]

/**
 * The source of scattered light, S(v) = s00 + s10 μ + s20 (3μ² − 1)/2 + s11 a + s21 μ a +
 * s22 (2a² − sin²θ sin²θ_s) [1/sr], where v is the direction that is looked in, μ and μ_s are its and
 * the sun's cosines with the slab's normal, ν that between them, and a = ν − μ μ_s.
 */
export interface SourceMoments {
  s00: number
  s10: number
  s20: number
  /** Over sin θ_s. */
  s11: number
  /** Over sin θ_s. */
  s21: number
  /** Over sin² θ_s. */
  s22: number
}

function dot(a: readonly number[], b: readonly number[]): number {
  let sum = 0
  for (let i = 0; i < a.length; i++) sum += a[i] * b[i]
  return sum
}

/** The light of one Fourier mode in azimuth: its modes in depth, whatever the slab's thickness. */
class AzimuthMode {
  /** Inverse lengths k of the modes, which go like e^{−kτ} [1]. */
  readonly #rates: number[]
  /** Amplitudes to values at the streams: of the sum and of the difference of both hemispheres. */
  readonly #sum: Matrix
  readonly #difference: Matrix
  /** Inverses (transposed) of the two above, without their normalisation. */
  readonly #sumDual: Matrix
  readonly #differenceDual: Matrix
  /** √(w/μ) Λ_l at the streams, by l − m. */
  readonly #basis: Matrix
  /** Amplitudes to moments c_l = ∫ Λ_l L dμ, by l − m. */
  readonly #moments: Matrix
  /** (2l + 1)/2 ω χ_l by l − m. */
  readonly weights: number[]
  readonly #m: number

  constructor(phase: ScaledPhase, m: number, streams: number) {
    const { nodes, weights } = gaussLegendre(streams)
    this.#m = m
    this.weights = polynomials[m].map(
      (_, i) => ((2 * (m + i) + 1) / 2) * phase.albedo * phase.moments[m + i]
    )
    // √w Λ_l at the streams
    const basis = polynomials[m].map(polynomial =>
      nodes.map((mu, i) => Math.sqrt(weights[i]) * polynomial(mu) * (1 - mu * mu) ** (m / 2))
    )
    /** M^{−½} (1 − 2 Σ b Λ Λᵀ) M^{−½} over the l of one parity. */
    const transport = (parity: number): Matrix =>
      nodes.map((muI, i) =>
        nodes.map((muJ, j) => {
          let value = i === j ? 1 : 0
          for (let l = parity; l < basis.length; l += 2) {
            value -= 2 * this.weights[l] * basis[l][i] * basis[l][j]
          }
          return value / Math.sqrt(muI * muJ)
        })
      )
    // p̂″ = X Y p̂ for p̂ the sum of both hemispheres; with X = L Lᵀ, z = L⁻¹ p̂: z″ = (Lᵀ Y L) z.
    const lower = cholesky(transport(1))
    const even = transport(0)
    const range = nodes.map((_, i) => i)
    const total = (term: (k: number) => number): number =>
      range.reduce((sum, k) => sum + term(k), 0)
    const evenLower = range.map(i => range.map(j => total(k => even[i][k] * lower[k][j])))
    const { values, vectors } = symmetricEigen(
      range.map(i => range.map(j => total(k => lower[k][i] * evenLower[k][j])))
    )
    this.#rates = values.map(value => Math.sqrt(Math.max(value, 1e-14)))
    const sum = range.map(i => range.map(j => total(k => lower[i][k] * vectors[k][j])))
    // L⁻ᵀ V, column by column
    const difference = range.map(() => range.map(() => 0))
    for (let j = 0; j < streams; j++) {
      for (let i = streams - 1; i >= 0; i--) {
        let value = vectors[i][j]
        for (let k = i + 1; k < streams; k++) value -= lower[k][i] * difference[k][j]
        difference[i][j] = value / lower[i][i]
      }
    }
    this.#sumDual = difference
    this.#differenceDual = sum
    const scale = range.map(i => 1 / Math.sqrt(nodes[i]))
    const roots = range.map(i => Math.sqrt(weights[i] * nodes[i]))
    this.#sum = range.map(i => sum[i].map(value => value / roots[i]))
    this.#difference = range.map(i => difference[i].map(value => value / roots[i]))
    this.#moments = basis.map((row, l) =>
      range.map(j => total(k => row[k] * scale[k] * (l % 2 === 0 ? sum : difference)[k][j]))
    )
    this.#basis = basis.map(row => row.map((value, i) => value * scale[i]))
  }

  /**
   * A slab of this medium.
   *
   * @param thickness - Scaled optical thickness, > 0.
   * @param depths - Where the light is wanted, from its top.
   */
  slab(thickness: number, depths: readonly number[]): SlabMode {
    const rates = this.#rates
    const range = rates.map((_, i) => i)
    const far = rates.map(rate => Math.exp(-rate * thickness))
    // Light that comes in at the top, then at the bottom; amplitudes of modes from the top and the bottom.
    const solve = factorize(
      [1, -1].flatMap(side =>
        range.map(i =>
          [1, -1].flatMap(origin =>
            range.map(j => {
              const light = this.#sum[i][j] + side * origin * rates[j] * this.#difference[i][j]
              return (light / 2) * (side === origin ? 1 : far[j])
            })
          )
        )
      )
    )
    // Amplitudes to moments, by depth and l − m.
    const moments = depths.map(depth => {
      const down = rates.map(rate => Math.exp(-rate * depth))
      const up = rates.map(rate => Math.exp(-rate * (thickness - depth)))
      return this.#moments.map((row, l) => [
        ...row.map((value, j) => value * down[j] * (l % 2 === 0 ? 1 : rates[j])),
        ...row.map((value, j) => value * up[j] * (l % 2 === 0 ? 1 : -rates[j]))
      ])
    })

    return {
      fromSun: cosSun => {
        const { rate, sum, difference } = this.#particular(cosSun)
        const end = Math.exp(-thickness * rate)
        const right = [1, -1].flatMap(side =>
          range.map(i => {
            const light = dot(this.#sum[i], sum) + side * dot(this.#difference[i], difference)
            return (-light / 2) * (side === 1 ? 1 : end)
          })
        )
        const amplitudes = solve(right)
        const forced = this.#moments.map((row, l) => dot(row, l % 2 === 0 ? sum : difference))
        return moments.map((rows, i) => {
          const beam = Math.exp(-depths[i] * rate)
          return rows.map((row, l) => dot(row, amplitudes) + beam * forced[l])
        })
      },
      fromAbove: () => {
        const amplitudes = solve([...range.map(() => 1), ...range.map(() => 0)])
        return moments.map(rows => rows.map(row => dot(row, amplitudes)))
      }
    }
  }

  /** The solution that goes with the beam of sunlight, of unit irradiance on a plane across it. */
  #particular(cosSun: number): Particular {
    // Where the beam resonates with a mode the solution is finite, but not by this formula.
    const resonates = (rate: number): boolean =>
      this.#rates.some(mode => Math.abs(mode / rate - 1) < 1e-7)
    let rate = 1 / cosSun
    while (resonates(rate)) rate *= 1 + 3e-7
    const azimuth = this.#m === 0 ? 1 : 2
    const strength = polynomials[this.#m].map(
      (polynomial, l) => (azimuth / Math.PI) * this.weights[l] * polynomial(cosSun)
    )
    const project = (dual: Matrix, parity: number): number[] =>
      dual[0].map((_, j) => {
        let value = 0
        for (let l = parity; l < strength.length; l += 2) {
          for (let i = 0; i < dual.length; i++)
            value += strength[l] * this.#basis[l][i] * dual[i][j]
        }
        return value
      })
    const even = project(this.#differenceDual, 0)
    const odd = project(this.#sumDual, 1)
    const sum = this.#rates.map((k, j) => (even[j] + rate * odd[j]) / (k * k - rate * rate))
    return { rate, sum, difference: sum.map((value, j) => rate * value + odd[j]) }
  }
}

/** A solution ∝ e^{−rate·τ}: amplitudes of the sum and the difference of both hemispheres. */
interface Particular {
  rate: number
  sum: number[]
  difference: number[]
}

/** Moments c_l by depth and l − m. */
interface SlabMode {
  fromSun: (cosSun: number) => number[][]
  fromAbove: () => number[][]
}

/** Light in a plane-parallel slab, at the depths that were asked for. */
export interface Slab {
  /**
   * Source of light that was scattered at least once before, for unit irradiance of the sun on a
   * plane across its rays.
   *
   * @param cosSun - μ_s, in (0, 1].
   */
  fromSun: (cosSun: number) => SourceMoments[]
  /** Source of scattered light, all orders, under an isotropic sky of radiance 1 above the slab. */
  fromAbove: () => Pick<SourceMoments, 's00' | 's10' | 's20'>[]
}

/**
 * Multiple scattering in homogeneous slabs by discrete ordinates.
 *
 * The phase function has three terms, so azimuth needs three Fourier modes. In each the streams'
 * coupled equations μ dL/dτ = S − L become, for the sum and the difference of both hemispheres, one
 * symmetric eigenproblem that does not depend on the slab's thickness nor on the sun; a slab is then
 * a small linear system.
 *
 * @see Stamnes & Swanson 1981; Nakajima & Tanaka 1986 (symmetric reduction)
 */
export class SlabSolver {
  readonly #modes: AzimuthMode[]

  /** @param streams - Directions per hemisphere. */
  constructor(phase: ScaledPhase, streams = STREAMS) {
    this.#modes = [0, 1, 2].map(m => new AzimuthMode(phase, m, streams))
  }

  /**
   * @param thickness - Scaled optical thickness, > 0.
   * @param depths - Scaled optical depths from its top, in [0, thickness].
   */
  slab(thickness: number, depths: readonly number[]): Slab {
    const modes = this.#modes.map(mode => mode.slab(thickness, depths))
    const [w0, w1, w2] = this.#modes.map(mode => mode.weights)
    return {
      fromSun: cosSun => {
        const [zeroth, first, second] = modes.map(mode => mode.fromSun(cosSun))
        return zeroth.map(([c00, c10, c20], i) => ({
          s00: w0[0] * c00,
          s10: w0[1] * c10,
          s20: w0[2] * c20,
          s11: w1[0] * Math.SQRT1_2 * first[i][0],
          s21: w1[1] * Math.sqrt(3 / 2) * first[i][1],
          s22: w2[0] * Math.sqrt(3 / 8) * second[i][0]
        }))
      },
      fromAbove: () =>
        modes[0].fromAbove().map(([c00, c10, c20]) => ({
          s00: w0[0] * c00,
          s10: w0[1] * c10,
          s20: w0[2] * c20
        }))
    }
  }
}
