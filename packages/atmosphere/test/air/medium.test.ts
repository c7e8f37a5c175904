import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { AtmosphereParameters, opticalDepth, standardEarthParameters } from '@welkin/atmosphere'
import { homogeneousHeight, molecularDensity } from '../../src/air/cpu/medium'
import { asymmetryMoments } from '../../src/air/cpu/phase'
import { number, runs, spectrumIndex } from '../arbitraries'

/** Altitude [km] and density [kg/m³]. U.S. Standard Atmosphere 1976, table I, geometric altitudes. */
const TABLE = [
  [0, 1.225],
  [1, 1.1117],
  [2, 1.0066],
  [3, 9.0925e-1],
  [5, 7.3643e-1],
  [7, 5.9002e-1],
  [10, 4.1351e-1],
  [12, 3.1194e-1],
  [15, 1.9476e-1],
  [20, 8.891e-2],
  [25, 4.0084e-2],
  [30, 1.841e-2],
  [35, 8.4634e-3],
  [40, 3.9957e-3],
  [45, 1.9663e-3],
  [50, 1.0269e-3],
  [55, 5.681e-4],
  [60, 3.0968e-4],
  [65, 1.6321e-4],
  [70, 8.2829e-5],
  [75, 3.9921e-5],
  [80, 1.8458e-5],
  [85, 8.2196e-6],
  [90, 3.416e-6],
  [95, 1.393e-6],
  [100, 5.604e-7]
] as const

const altitudes = number(100, 100_000)
const scaleHeights = number(2000, 20_000)

/** Air with up to three layers above the lowest. */
const layered = fc
  .tuple(scaleHeights, fc.array(fc.tuple(altitudes, scaleHeights), { maxLength: 3 }))
  .map(
    ([rayleighScaleHeight, layers]) =>
      new AtmosphereParameters({
        rayleighScaleHeight,
        rayleighLayers: layers.toSorted(([a], [b]) => a - b)
      })
  )

describe('density of molecules', () => {
  it('is a plain exponential to the last digit where there are no layers', () => {
    const earth = new AtmosphereParameters()
    expect(earth.rayleighLayers).toEqual([])
    for (let altitude = 0; altitude < 120_000; altitude += 37) {
      expect(molecularDensity(earth, altitude)).toBe(Math.exp(-altitude / 8000))
    }
    expect(homogeneousHeight(earth)).toBe(8000)
  })

  it('is that of the U.S. Standard Atmosphere', () => {
    const air = standardEarthParameters()
    for (const [kilometres, density] of TABLE) {
      const error = Math.abs((molecularDensity(air, 1e3 * kilometres) * 1.225) / density - 1)
      const tolerance = kilometres <= 60 ? 0.035 : kilometres <= 90 ? 0.07 : 0.2
      expect(error, `${kilometres} km`).toBeLessThan(tolerance)
    }
    // 1013.25 hPa over 1.225 kg/m³ and the gravity of where the air is, 0.25 % less than at sea level.
    expect(homogeneousHeight(air) / (101_325 / 1.225 / 9.782)).toBeCloseTo(1, 2)
  })

  it('falls by each layer’s scale height, without a jump', () => {
    fc.assert(
      fc.property(layered, number(0, 119_000), (air, altitude) => {
        const [here, above] = [altitude, altitude + 1].map(h => molecularDensity(air, h)) as [
          number,
          number
        ]
        const heights = [air.rayleighScaleHeight, ...air.rayleighLayers.map(layer => layer[1])]
        const bases = [0, ...air.rayleighLayers.map(layer => layer[0])]
        const within = (h: number): number => heights[bases.findLastIndex(base => base <= h)]
        const rates = [1 / within(altitude), 1 / within(altitude + 1)]
        const rate = Math.log(here / above)
        expect(rate).toBeGreaterThan(Math.min(...rates) - 1e-9)
        expect(rate).toBeLessThan(Math.max(...rates) + 1e-9)
      }),
      { ...runs, numRuns: 200 }
    )
  })

  it('sums to the height of the homogeneous atmosphere', () => {
    fc.assert(
      fc.property(layered, air => {
        const step = 10
        let sum = 0
        for (let h = step / 2; h < 600_000; h += step) sum += step * molecularDensity(air, h)
        expect(sum / homogeneousHeight(air)).toBeCloseTo(1, 4)
      }),
      { ...runs, numRuns: 20 }
    )
  })
})

describe('standardEarthParameters', () => {
  it('has the optical depths that were measured', () => {
    const depth = (air: AtmosphereParameters): number[] =>
      opticalDepth(air, air.bottomRadius, 1, 100_000)
    const molecules = depth(standardEarthParameters({ aerosolOpticalDepth: 0, ozone: 0 }))
    const wavelengths = [440, 520, 560, 630]
    for (const i of spectrumIndex) {
      // Hansen & Travis 1974, Space Sci. Rev. 16, eq. 2.30, for 1013 hPa.
      const square = (1e-3 * wavelengths[i]) ** -2
      const published = 0.008569 * square ** 2 * (1 + 0.0113 * square + 0.00013 * square ** 2)
      expect(Math.abs(molecules[i] / published - 1)).toBeLessThan(0.01)
    }
    const [clear, hazy] = [0.05, 0.4].map(aerosolOpticalDepth =>
      depth(standardEarthParameters({ aerosolOpticalDepth, ozone: 0 }))
    ) as [number[], number[]]
    for (const i of spectrumIndex) {
      const expected = 0.35 * (wavelengths[i] / 550) ** -1.3
      expect((hazy[i] - clear[i]) / expected).toBeCloseTo(1, 4)
    }
    expect(asymmetryMoments(0.64)[1]).toBeCloseTo(0.703, 3)
  })

  it('takes ozone as the default does', () => {
    expect(standardEarthParameters({ ozone: 400 }).absorptionExtinction).toEqual(
      new AtmosphereParameters({ ozone: 400 }).absorptionExtinction
    )
  })

  it('wants sensible numbers', () => {
    expect(() => standardEarthParameters({ aerosolOpticalDepth: -0.1 })).toThrow(
      'standardEarthParameters: aerosolOpticalDepth must be in [0, 5], got -0.1'
    )
    expect(() => standardEarthParameters({ ozone: NaN })).toThrow('ozone must be')
  })
})
