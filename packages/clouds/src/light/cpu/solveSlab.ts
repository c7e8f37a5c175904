import { gaussLegendre } from '@welkin/atmosphere'
import type { ScaledPhase } from './cloudPhase'
import { dot, factorize, matrix, product, symmetricEigen, type Matrix } from './matrices'

/** Streams per hemisphere: moments of the light are within 1e-4 of 24 streams for light up to 85° from the normal. */
const STREAMS = 8

/** Associated Legendre functions for l ≤ 2 over sin^m θ, by l − m, scaled to 1 at the zenith. */
const polynomials: ((mu: number) => number)[] = [
  () => 1,
  mu => mu,
  // Of m = 0 alone.
  mu => (3 * mu * mu - 1) / 2
]

/** (2l + 1)/2 times what their squares lack of those of normalised ones, by m and l − m. */
const weightsOf = [[1 / 2, 3 / 2, 5 / 2], [3 / 4, 15 / 4], [15 / 16]]

/**
 * The source of scattered light, S(v) = s00 + s10 μ + s20 (3μ² − 1)/2 + s11 a + s21 μ a +
 * s22 (2a² − sin²θ sin²θ_s) [1/sr], where v is the direction that is looked in, μ and μ_s are its and
 * the light's cosines with the slab's normal, ν that between them, and a = ν − μ μ_s.
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

/** Hemispheres that look at the sky and at the ground, or faces that look there. */
const SIDES = [1, -1] as const

/** The light of one Fourier mode in azimuth: its modes in depth, whatever the slab's thickness. */
class AzimuthMode {
  readonly #m: number
  /** Inverse lengths k of the modes, which go like e^{−kτ} [1]. */
  readonly #rates: number[]
  /** Amplitudes to values at the streams: of the sum and of the difference of both hemispheres. */
  readonly #light: readonly [Matrix, Matrix]
  /** Amplitudes to terms of the source for sin θ = 1, by l − m. */
  readonly #sources: Matrix

  constructor(phase: ScaledPhase, m: number, streams: number) {
    const { nodes, weights } = gaussLegendre(streams)
    this.#m = m
    const factors = weightsOf[m].map((weight, i) => weight * phase.albedo * phase.moments[m + i])
    // √(w/μ) p_l sin^m θ at the streams
    const basis = factors.map((_, l) =>
      nodes.map(
        (mu, i) => Math.sqrt(weights[i] / mu) * polynomials[l](mu) * (1 - mu * mu) ** (m / 2)
      )
    )
    /** M^{−½} (1 − 2 Σ b Λ Λᵀ) M^{−½} over the l of one parity. */
    const transport = (parity: number): Matrix =>
      matrix(nodes, (i, j) =>
        basis.reduce(
          (sum, row, l) => (l % 2 === parity ? sum - 2 * factors[l] * row[i] * row[j] : sum),
          i === j ? 1 / nodes[i] : 0
        )
      )
    // p̂″ = X Y p̂ for p̂ the sum of both hemispheres; with z = X^{−½} p̂: z″ = (X^½ Y X^½) z.
    const { values: squares, vectors: axes } = symmetricEigen(transport(1))
    const power = (exponent: number): Matrix =>
      matrix(nodes, (i, j) =>
        squares.reduce((sum, square, k) => sum + square ** exponent * axes[i][k] * axes[j][k], 0)
      )
    const root = power(0.5)
    const { values, vectors } = symmetricEigen(product(product(root, transport(0)), root))
    this.#rates = values.map(value => Math.sqrt(Math.max(value, 1e-14)))
    const parts = [product(root, vectors), product(power(-0.5), vectors)]
    const [sum, difference] = parts.map(part =>
      part.map((row, i) => row.map(value => value / Math.sqrt(weights[i] * nodes[i])))
    )
    this.#light = [sum, difference]
    this.#sources = basis.map((row, l) => {
      const [moments] = product([row], parts[l % 2])
      return moments.map(value => factors[l] * value)
    })
  }

  /**
   * A slab of this medium.
   *
   * @param thickness - Scaled optical thickness, > 0.
   * @param depths - Optical depths at which the light is wanted, from its top.
   */
  slab(thickness: number, depths: readonly number[]): SlabMode {
    const rates = this.#rates
    const [sums, differences] = this.#light
    // Light that comes in at the top, then at the bottom; amplitudes of modes from the top and the bottom.
    const solve = factorize(
      SIDES.flatMap(side =>
        sums.map((row, i) =>
          SIDES.flatMap(origin =>
            row.map((sum, j) => {
              const light = sum + side * origin * rates[j] * differences[i][j]
              return side === origin ? light : light * Math.exp(-rates[j] * thickness)
            })
          )
        )
      )
    )
    // Amplitudes to terms of the source, by depth and l − m.
    const sources = depths.map(depth =>
      this.#sources.map((row, l) =>
        SIDES.flatMap(side => {
          const path = side === 1 ? depth : thickness - depth
          return row.map(
            (value, j) => value * Math.exp(-rates[j] * path) * (side * rates[j]) ** (l % 2)
          )
        })
      )
    )

    return {
      fromBeam: cosLight => {
        // Where the beam resonates with a mode the solution is finite, but not by this formula.
        const resonates = (rate: number): boolean =>
          rates.some(mode => Math.abs(mode / rate - 1) < 1e-7)
        let rate = 1 / cosLight
        while (resonates(rate)) rate *= 1 + 3e-7
        // The solution that goes with the beam, of unit irradiance on a plane across it.
        const azimuth = this.#m === 0 ? 1 : 2
        const strength = polynomials.map(polynomial => (azimuth * polynomial(cosLight)) / Math.PI)
        const [even, odd] = [0, 1].map(parity =>
          rates.map((_, j) =>
            this.#sources.reduce(
              (sum, row, l) => (l % 2 === parity ? sum + strength[l] * row[j] : sum),
              0
            )
          )
        )
        const sum = rates.map((k, j) => (even[j] + rate * odd[j]) / (k * k - rate * rate))
        const difference = sum.map((value, j) => rate * value + odd[j])
        const end = Math.exp(-thickness * rate)
        const amplitudes = solve(
          SIDES.flatMap(side =>
            sums.map((row, i) => {
              const light = dot(row, sum) + side * dot(differences[i], difference)
              return side === 1 ? -light : -light * end
            })
          )
        )
        const forced = this.#sources.map((row, l) => dot(row, l % 2 === 0 ? sum : difference))
        return sources.map((rows, i) => {
          const beam = Math.exp(-depths[i] * rate)
          return rows.map((row, l) => dot(row, amplitudes) + beam * forced[l])
        })
      },
      fromSky: () => {
        const amplitudes = solve(SIDES.flatMap(side => rates.map(() => 1 + side)))
        return sources.map(rows => rows.map(row => dot(row, amplitudes)))
      }
    }
  }
}

/** Terms of the source by depth and l − m. */
interface SlabMode {
  fromBeam: (cosLight: number) => number[][]
  fromSky: () => number[][]
}

/** Light in a plane-parallel slab, at the depths that were asked for. */
export interface Slab {
  /**
   * Source of light that was scattered at least once before, for unit irradiance of the beam on a
   * plane across it.
   *
   * @param cosLight - μ_s, in (0, 1].
   */
  fromBeam: (cosLight: number) => SourceMoments[]
  /** Source of scattered light, all orders, under an isotropic sky of radiance 1 above the slab. */
  fromSky: () => Pick<SourceMoments, 's00' | 's10' | 's20'>[]
}

/**
 * Multiple scattering in homogeneous slabs by discrete ordinates.
 *
 * The phase function has three terms, so azimuth needs three Fourier modes. In each the streams'
 * coupled equations μ dL/dτ = S − L become, for the sum and the difference of both hemispheres, one
 * symmetric eigenproblem that does not depend on the slab's thickness nor on the light; a slab is then
 * a small linear system.
 *
 * @see Liou 2002, An Introduction to Atmospheric Radiation, 2nd ed., §6.2 (discrete ordinates), after Stamnes & Swanson
 *   1981, "A new look at the discrete ordinate method for radiative transfer calculations in anisotropically
 *   scattering atmospheres"; the symmetric reduction is that of Nakajima & Tanaka 1986, "Matrix formulations for the
 *   transfer of solar radiation in a plane-parallel scattering atmosphere"
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
    return {
      fromBeam: cosLight => {
        const [zeroth, first, second] = modes.map(mode => mode.fromBeam(cosLight))
        return zeroth.map(([s00, s10, s20], i) => {
          const [s11, s21] = first[i]
          return { s00, s10, s20, s11, s21, s22: second[i][0] }
        })
      },
      fromSky: () => modes[0].fromSky().map(([s00, s10, s20]) => ({ s00, s10, s20 }))
    }
  }
}
