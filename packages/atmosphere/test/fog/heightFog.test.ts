import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { DistanceFog } from '../../src/fog/DistanceFog'
import { HeightFog } from '../../src/fog/HeightFog'
import { ERFCX_COEFFICIENTS, ERFCX_SCALE } from '../../src/fog/tsl/erfcx'
import { erfcx, fogDepth, multipleScattering } from '../twins/fog/heightFog'
import type { FogLayer } from '../twins/fog/heightFog'
import { gaussLegendre } from '../../src/math/cpu/quadrature'
import { number, runs } from '../arbitraries'

const BOTTOM = 6_371_000
const RULE = gaussLegendre(12)

/** Optical depth by quadrature of the density along the ray, in pieces that crowd at its lowest point. */
function integrated(
  { density, falloff, base }: FogLayer,
  radius: number,
  cosView: number,
  distance: number
): number {
  const lowest = Math.min(Math.max(-radius * cosView, 0), distance)
  const at = (t: number): number => {
    // h' − h without cancellation.
    const rise = (2 * radius * cosView + t) * t
    const there = Math.sqrt(radius ** 2 + rise)
    return Math.exp(-(radius - BOTTOM - base + rise / (there + radius)) / falloff)
  }
  let sum = 0
  for (const end of [0, distance]) {
    const pieces = 400
    for (let i = 0; i < pieces; i++) {
      const edge = (x: number): number => lowest + (end - lowest) * (x / pieces) ** 3
      const [a, b] = [edge(i), edge(i + 1)]
      RULE.nodes.forEach((node, k) => {
        sum += at(a + (b - a) * node) * RULE.weights[k] * Math.abs(b - a)
      })
    }
  }
  return sum * density
}

describe('e^{x²} erfc x', () => {
  it('agrees with known values', () => {
    // Abramowitz & Stegun, table 7.1: erfc.
    expect(erfcx(0)).toBe(1)
    expect(erfcx(1) * Math.exp(-1)).toBeCloseTo(0.157299207, 9)
    expect(erfcx(2) * Math.exp(-4)).toBeCloseTo(0.004677735, 9)
    expect(erfcx(30)).toBeCloseTo(1 / (30 * Math.sqrt(Math.PI)) / (1 + 1 / 1800), 6)
  })

  it('is the shader’s polynomial within 7e-6, exact in value and slope at 0', () => {
    const polynomial = (x: number): number => {
      const t = 1 / (1 + ERFCX_SCALE * x)
      return ERFCX_COEFFICIENTS.reduce((sum, a, k) => sum + a * t ** (k + 1), 0)
    }
    fc.assert(
      fc.property(number(-4, 4), exponent => {
        const x = 10 ** exponent
        expect(Math.abs(polynomial(x) / erfcx(x) - 1)).toBeLessThan(7e-6)
      }),
      runs
    )
    expect(polynomial(0)).toBeCloseTo(1, 12)
    expect((polynomial(1e-6) - 1) / 1e-6).toBeCloseTo(-2 / Math.sqrt(Math.PI), 4)
  })
})

describe('optical depth of height fog', () => {
  const height = number(-2, 9)
  const falloff = number(10, 500)

  it('is the integral of the density along any ray', () => {
    fc.assert(
      fc.property(
        height,
        falloff,
        number(-1, 1),
        number(0.5, 5.3),
        (heights, scale, bend, exponent) => {
          const layer = { density: 0.01, falloff: scale, base: 300 }
          const radius = BOTTOM + layer.base + heights * scale
          // Many rays near the horizontal, where the planet's curve counts.
          const cosView = bend ** 3
          const distance = 10 ** exponent
          // Rays that go deeper than 30 falloff heights below the base have no end of fog.
          const nearest = Math.min(Math.max(-radius * cosView, 0), distance)
          const deepest = Math.sqrt(radius ** 2 + (2 * radius * cosView + nearest) * nearest)
          fc.pre(deepest - BOTTOM - layer.base > -20 * scale)
          const expected = integrated(layer, radius, cosView, distance)
          const actual = fogDepth(layer, radius, cosView, BOTTOM, distance)
          expect(Math.abs(actual - expected)).toBeLessThan(2e-3 * expected + 1e-9)
        }
      ),
      runs
    )
  })

  it('of a vertical ray is σH', () => {
    const layer = { density: 0.02, falloff: 60, base: 0 }
    expect(fogDepth(layer, BOTTOM, 1, BOTTOM, 1e5)).toBeCloseTo(0.02 * 60, 4)
    expect(fogDepth(layer, BOTTOM + 1e5, -1, BOTTOM, 1e5)).toBeCloseTo(0.02 * 60, 4)
  })

  it('of a long horizontal ray is σ√(πrH/2), where a flat world would have no end of it', () => {
    const layer = { density: 0.001, falloff: 100, base: 0 }
    const expected = 0.001 * Math.sqrt((Math.PI * BOTTOM * 100) / 2)
    expect(fogDepth(layer, BOTTOM, 0, BOTTOM, 1e6) / expected).toBeCloseTo(1, 4)
  })

  it('is the same from both ends and adds up', () => {
    fc.assert(
      fc.property(number(0, 400), number(-0.02, 0.02), number(100, 40_000), (h, mu, d) => {
        const layer = { density: 0.01, falloff: 50, base: 100 }
        const r = BOTTOM + h
        const there = Math.sqrt(r ** 2 + (2 * r * mu + d) * d)
        const back = fogDepth(layer, there, -(r * mu + d) / there, BOTTOM, d)
        const whole = fogDepth(layer, r, mu, BOTTOM, d)
        expect(Math.abs(back - whole)).toBeLessThan(1e-5 * whole + 1e-9)
        const half = Math.sqrt(r ** 2 + (r * mu + d / 4) * d)
        const first = fogDepth(layer, r, mu, BOTTOM, d / 2)
        const second = fogDepth(layer, half, (r * mu + d / 2) / half, BOTTOM, d / 2)
        expect(Math.abs(first + second - whole)).toBeLessThan(1e-5 * whole + 1e-9)
      }),
      runs
    )
  })
})

describe('multiple scattering in fog', () => {
  it('solves Eddington’s equation and both boundaries', () => {
    fc.assert(
      fc.property(number(0.05, 10), number(0.1, 1), number(0.02, 0.98), (whole, mu, part) => {
        const field = (depth: number): number => multipleScattering(depth, whole, mu)
        const depth = whole * part
        const step = 1e-3 * Math.min(whole, mu)
        const bend = (field(depth - step) - 2 * field(depth) + field(depth + step)) / step ** 2
        const source = (-3 / (4 * Math.PI)) * Math.exp(-depth / mu)
        expect(Math.abs(bend - source)).toBeLessThan(1e-4)
        const slope = (at: number, sign: number): number => {
          const [a, b, c] = [field(at), field(at + sign * step), field(at + 2 * sign * step)]
          return (sign * (4 * b - 3 * a - c)) / (2 * step)
        }
        expect(Math.abs(field(0) - (2 / 3) * slope(0, 1))).toBeLessThan(1e-4)
        expect(Math.abs(field(whole) + (2 / 3) * slope(whole, -1))).toBeLessThan(1e-4)
      }),
      runs
    )
  })
})

describe('version of a fog', () => {
  it('counts changes and nothing else', () => {
    const height = new HeightFog({ density: 0.01 })
    const { version } = height
    height.set({}).set({ density: 0.01, fade: [5000, 15_000], albedo: [1, 1, 1, 1] })
    expect(height.version).toBe(version)
    height
      .set({ density: 0.02 })
      .set({ albedo: [1, 1, 1, 0.9] })
      .set({ fade: [5000, 16_000] })
    expect(height.version).toBe(version + 3)
    expect(() => height.set({ density: -1 })).toThrow('density')
    expect(height.version).toBe(version + 3)

    const distance = new DistanceFog({ density: 1e-4 })
    const before = distance.version
    distance.density = 1e-4
    expect(distance.version).toBe(before)
    distance.density = 2e-4
    expect(distance.version).toBe(before + 1)
  })
})

describe('fog', () => {
  it('says which option is wrong', () => {
    expect(() => new HeightFog({ falloff: 0 })).toThrow('HeightFog: falloff must be in [0.1, 1')
    expect(() => new HeightFog({ density: NaN })).toThrow('density must be in [0, 100], got NaN')
    expect(() => new HeightFog({ albedo: [1, 1, 1, 2] })).toThrow('albedo[3]')
    expect(() => new HeightFog({ fade: [5, 5] })).toThrow('fade must rise, got [5, 5]')
    expect(() => new HeightFog().set({ asymmetry: 1 })).toThrow('asymmetry')
    expect(() => new DistanceFog({ density: -1 })).toThrow('DistanceFog: density must be in')
    expect(new HeightFog().set({ base: 20 }).falloff).toBe(50)
  })
})
