import { describe, expect, it } from 'vitest'
import { AtmosphereParameters, heightFog, raindrops } from '@welkin/atmosphere'
import { whiteBalancedColumns } from '../../src/air/cpu/color'
import { HALF_TEXELS, texelCosine } from '../../src/optics/cpu/phaseRow'
import { rainRow } from '../../src/optics/cpu/rainRow'
import { throwsEach, wrong } from '../harness/wrong'

const TEXELS = 2 * HALF_TEXELS

/** Angle of a texel from the point opposite the sun [°]. */
const angles = Array.from(
  { length: TEXELS },
  (_, i) => 180 - (Math.acos(texelCosine(i)) * 180) / Math.PI
)

const columns = whiteBalancedColumns(new AtmosphereParameters())

const rates = [0.5, 2, 10, 50]

describe('rain', () => {
  for (const rate of rates) {
    const { texels, moments } = rainRow(rate)
    /** Angle at which a wavelength is brightest over a middle one, between two angles [°]. */
    const brightest = (wave: number, from: number, to: number): number => {
      const inside = angles.map((_, i) => i).filter(i => angles[i] >= from && angles[i] <= to)
      const excess = (i: number): number => texels[4 * i + wave]
      return angles[inside.reduce((best, i) => (excess(i) > excess(best) ? i : best), inside[0])]
    }
    const mean = (from: number, to: number): number => {
      const inside = angles.map((_, i) => i).filter(i => angles[i] >= from && angles[i] <= to)
      return inside.reduce((sum, i) => sum + texels[4 * i + 2], 0) / inside.length
    }

    // Lee & Fraser 2001, "The rainbow bridge", ch. 8: 40.6 to 42.4°, and 50.4 to 53.4° with colours reversed.
    it(`of ${rate} mm/h has both bows where they are, the outer one reversed`, () => {
      const [violet, red] = [0, 3].map(wave => brightest(wave, 38, 45))
      expect(violet).toBeGreaterThan(39.9)
      expect(violet).toBeLessThan(red)
      expect(red).toBeGreaterThan(41.4)
      expect(red).toBeLessThan(42.4)
      const [outerViolet, outerRed] = [0, 3].map(wave => brightest(wave, 48, 56))
      expect(outerRed).toBeGreaterThan(50.3)
      expect(outerRed).toBeLessThan(outerViolet)
      expect(outerViolet).toBeLessThan(54)
    })

    it(`of ${rate} mm/h is dark between them, bright inside the first`, () => {
      expect(mean(30, 38)).toBeGreaterThan(4 * mean(44, 49))
      expect(mean(41, 42)).toBeGreaterThan(2 * mean(30, 38))
      expect(mean(51, 53)).toBeGreaterThan(2.5 * mean(44, 49))
      expect(mean(56, 60)).toBeGreaterThan(1.3 * mean(44, 49))
    })

    it(`of ${rate} mm/h has both bows in the colours that one sees, in opposite orders about the dark band`, () => {
      /** Colour that sunlight gets, in linear sRGB over white, in the mean between two angles. */
      const colorOf = (from: number, to: number): number[] => {
        const inside = angles.map((_, i) => i).filter(i => angles[i] >= from && angles[i] <= to)
        return [0, 1, 2].map(c => {
          const ofTexel = (i: number): number =>
            columns.reduce((sum, column, k) => sum + column[c] * texels[4 * i + k], 0)
          return inside.reduce((sum, i) => sum + ofTexel(i), 0) / inside.length
        })
      }
      const redness = ([red, , blue]: readonly number[]): number => red / blue
      // Edges of both bows, from red to violet and from violet to red; and the band between.
      const [violet, red] = [colorOf(40.2, 41), colorOf(41.9, 42.5)]
      const [outerRed, outerViolet] = [colorOf(50, 51.4), colorOf(53, 54)]
      const band = colorOf(44, 49)
      expect(redness(red)).toBeGreaterThan(1.5)
      expect(redness(violet)).toBeLessThan(1)
      expect(redness(outerRed)).toBeGreaterThan(1.5)
      expect(redness(outerViolet)).toBeLessThan(1)
      for (const edge of [violet, red, outerRed, outerViolet])
        expect(Math.max(...edge)).toBeGreaterThan(2 * Math.max(...band))
    })

    it(`of ${rate} mm/h scatters all light, most of it on`, () => {
      for (let k = 0; k < 4; k++) {
        let sum = 0
        for (let i = 1; i < TEXELS; i++) {
          const width = texelCosine(i - 1) - texelCosine(i)
          sum += Math.PI * width * (texels[4 * i + k] + texels[4 * i - 4 + k])
        }
        expect(Math.abs(sum - 1)).toBeLessThan(0.03)
      }
      expect(moments[0]).toBeGreaterThan(0.86)
      expect(moments[0]).toBeLessThan(0.92)
    })
  }

  it('dims as Atlas found', () => {
    const rain = raindrops({ rate: 10 })
    expect(1000 * rain.extinction).toBeCloseTo(1.44, 2)
    const fog = heightFog({ droplets: rain })
    const { version } = fog
    rain.rate = 20
    expect(fog.version).toBeGreaterThan(version)
    expect(rain.rate).toBe(20)
    rain.dispose()
  })

  it('scatters below and above the rates of its table as at their ends, and dims by its own', () => {
    for (const [rate, end] of [
      [0, 0.5],
      [0.07, 0.5],
      [300, 50]
    ]) {
      expect(rainRow(rate)).toEqual(rainRow(end))
      const rain = raindrops({ rate })
      expect(1000 * rain.extinction).toBeCloseTo(0.33 * rate ** 0.64, 9)
      rain.dispose()
    }
  })

  throwsEach('rain', [
    ['Raindrops: rate must be in [0, 300], got -1', () => raindrops({ rate: -1 })],
    ['Raindrops: rate must be in [0, 300], got 301', () => raindrops({ rate: 301 })],
    ["Raindrops: unknown option 'radius', there are rate", () => raindrops(wrong({ radius: 1 }))]
  ])
})
