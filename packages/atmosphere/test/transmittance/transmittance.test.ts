import { fileURLToPath } from 'node:url'
import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { AtmosphereParameters } from '@welkin/atmosphere'
import { readSkyReference } from '../../../../e2e/validate/reference'
import { distanceToTop } from '../../src/air/cpu/boundary'
import {
  opticalDepth,
  lightTransmittance,
  visibleDisc
} from '../../src/transmittance/cpu/transmittance'
import { number, runs, spectrumIndex } from '../arbitraries'

const earth = new AtmosphereParameters()
const { bottomRadius, topRadius } = earth

/** Column of an exponential profile between two altitudes. */
const column = (from: number, to: number, scale: number): number =>
  scale * (Math.exp(-from / scale) - Math.exp(-to / scale))

describe('transmittance', () => {
  it('of the zenith is that of the columns of air', () => {
    fc.assert(
      fc.property(number(0, 9_000), altitude => {
        const depth = opticalDepth(earth, bottomRadius + altitude, 1, 60_000 - altitude)
        for (const i of spectrumIndex) {
          const expected =
            earth.rayleighScattering[i] * column(altitude, 60_000, earth.rayleighScaleHeight) +
            earth.mieExtinction[i] * column(altitude, 60_000, earth.mieScaleHeight) +
            earth.absorptionExtinction[i] * earth.absorptionHalfWidth
          // The tent's kinks cost the quadrature this much of the ozone.
          expect(Math.abs(depth[i] / expected - 1)).toBeLessThan(2e-3)
        }
      }),
      { ...runs, numRuns: 60 }
    )
  })

  it('is the same both ways along a segment, and multiplies', () => {
    fc.assert(
      fc.property(number(0, 50_000), number(0.05, 1), number(0.1, 0.9), (altitude, mu, part) => {
        const radius = bottomRadius + altitude
        const length = distanceToTop(radius, mu, topRadius)
        const first = part * length
        const there = Math.sqrt(radius ** 2 + 2 * radius * mu * first + first ** 2)
        const muThere = (radius * mu + first) / there
        const whole = opticalDepth(earth, radius, mu, length)
        const near = opticalDepth(earth, radius, mu, first)
        const far = opticalDepth(earth, there, muThere, length - first)
        const back = opticalDepth(earth, there, -muThere, first)
        for (const i of spectrumIndex) {
          expect(Math.abs(near[i] + far[i] - whole[i])).toBeLessThan(2e-3 * whole[i] + 1e-7)
          expect(Math.abs(near[i] - back[i])).toBeLessThan(2e-3 * near[i] + 1e-7)
        }
      }),
      { ...runs, numRuns: 60 }
    )
  })

  it('falls as the sun sinks', () => {
    fc.assert(
      fc.property(number(0, 60_000), number(-0.2, 1), number(-0.2, 1), (altitude, a, b) => {
        const [low, high] = [Math.min(a, b), Math.max(a, b)].map(cosLight =>
          lightTransmittance(earth, bottomRadius + altitude, cosLight)
        )
        for (const i of spectrumIndex) {
          expect(low[i]).toBeGreaterThanOrEqual(0)
          expect(high[i]).toBeLessThanOrEqual(1)
          expect(low[i]).toBeLessThanOrEqual(high[i] * (1 + 2e-3) + 1e-12)
        }
      }),
      { ...runs, numRuns: 100 }
    )
  })

  it('halves the disc on the horizon and ends in the shadow of the planet', () => {
    for (const height of [0, 1e4, 4e5, 2e7]) {
      const radius = bottomRadius + height
      const horizon = -Math.sqrt(1 - (bottomRadius / radius) ** 2)
      expect(visibleDisc(earth, radius, horizon)).toBeCloseTo(0.5, 9)
      expect(visibleDisc(earth, radius, horizon - 0.005)).toBe(0)
      expect(visibleDisc(earth, radius, horizon + 0.005)).toBe(1)
    }
    expect(lightTransmittance(earth, 3 * bottomRadius, -1)).toEqual([0, 0, 0, 0])
    expect(lightTransmittance(earth, 3 * bottomRadius, 0.5)).toEqual([1, 1, 1, 1])
  })

  it('averages the part of the disc above the horizon, wherever the sun stands', () => {
    const strips = 400
    fc.assert(
      fc.property(number(0, 100_000), number(-0.0046, 0.3), number(0, 19), (height, e, haze) => {
        const p = new AtmosphereParameters({ turbidity: 1 + haze })
        const radius = bottomRadius + height
        const horizon = Math.PI - Math.asin(bottomRadius / radius)
        const elevation = Math.sign(e) * e ** 2 * (e < 0 ? 200 : 3)
        const visible = visibleDisc(p, radius, Math.cos(horizon - elevation))
        const light = [0, 0, 0, 0]
        let area = 0
        for (let strip = 0; strip < strips; strip++) {
          const y = (2 * strip + 1) / strips - 1
          const above = elevation + y * p.sunAngularRadius
          if (above < 0) continue
          const width = Math.sqrt(1 - y * y)
          const mu = Math.cos(horizon - above)
          const lowest = radius * Math.sqrt(1 - mu * mu)
          const half = Math.sqrt(Math.max(topRadius ** 2 - lowest ** 2, 0))
          const misses = lowest > topRadius || (radius > topRadius && mu > 0)
          const start = radius > topRadius && !misses ? -radius * mu - half : 0
          const length = misses ? 0 : half - radius * mu - start
          const r = Math.sqrt(radius ** 2 + 2 * radius * mu * start + start ** 2)
          const depth = opticalDepth(p, r, (radius * mu + start) / r, length)
          area += width
          depth.forEach((value, i) => (light[i] += width * Math.exp(-value)))
        }
        const actual = lightTransmittance(p, radius, Math.cos(horizon - elevation))
        for (const i of spectrumIndex) {
          const expected = area > 0 ? (visible * light[i]) / area : 0
          expect(Math.abs(actual[i] - expected)).toBeLessThan(1e-4)
        }
      }),
      { ...runs, numRuns: 60 }
    )
  })

  it('agrees with the reference', () => {
    const file = fileURLToPath(new URL('../../../../e2e/reference/sky.json', import.meta.url))
    const { parameters, channels, segments } = readSkyReference(file)
    const air = new AtmosphereParameters(parameters)
    const errors = segments!.flatMap(segment => {
      const mu = Math.cos((segment.view_zenith_deg * Math.PI) / 180)
      const radius = air.bottomRadius + 1e3 * segment.h_km
      const depth = opticalDepth(air, radius, mu, 1e3 * segment.distance_km)
      return segment.transmittance
        .slice(0, channels)
        .map((value, i) => Math.abs(Math.exp(-depth[i]) / value - 1))
    })
    const sorted = errors.toSorted((a, b) => a - b)
    expect(errors.length).toBeGreaterThan(100)
    expect(sorted[Math.floor(0.95 * sorted.length)]).toBeLessThan(1e-3)
  })
})
