import * as fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { spectralToLinearSRGB } from '../../src/air/cpu/color'
import { AtmosphereParameters } from '../../src/parameters/AtmosphereParameters'
import { luminanceOf, NIGHT, purkinjeShift } from '../twins/exposure/purkinjeShift'

type Color = [number, number, number]

const number = (min: number, max: number) => fc.double({ min, max, noNaN: true })
const colors = fc.tuple(number(0, 1), number(0, 1), number(0, 1)).filter(c => luminanceOf(c) > 1e-3)

/** A colour at a luminance [cd/m²]. */
const at = (color: Color, luminance: number): Color =>
  color.map(value => (value * luminance) / luminanceOf(color)) as Color
const seen = (color: Color, adaptation = 1e-6, strength = 1): Color =>
  purkinjeShift(color, { luminanceScale: 1, adaptation, strength })

const WHITE: Color = [1, 1, 1]
const RED: Color = [1, 0, 0]
const GREEN: Color = [0, 1, 0]
const BLUE: Color = [0, 0, 1]

describe('purkinjeShift', () => {
  it('leaves what is brighter than 5 cd/m² or seen by adapted eyes, and all at strength 0', () => {
    fc.assert(
      fc.property(colors, number(1e-5, 5), number(5, 1e5), (color, dark, bright) => {
        for (const [same, adaptation, strength] of [
          [at(color, bright), dark, 1],
          [at(color, dark), bright, 1],
          [at(color, dark), dark, 0]
        ] as const) {
          const shown = seen(same, adaptation, strength)
          shown.forEach((value, i) => expect(value).toBeCloseTo(same[i], 9 - Math.log10(bright)))
        }
      })
    )
  })

  it('shows white by night as bluish grey of the same luminance', () => {
    for (const luminance of [1e-4, 1e-3, 0.01, 0.1, 1]) {
      const shown = seen(at(WHITE, luminance))
      expect(luminanceOf(shown) / luminance).toBeCloseTo(1, 6)
      expect(shown[2]).toBeGreaterThan(shown[1])
      expect(shown[1]).toBeGreaterThan(shown[0])
    }
  })

  it('has one hue for all where only rods see', () => {
    fc.assert(
      fc.property(colors, number(1e-5, 0.005), (color, luminance) => {
        const [r, g, b] = seen(at(color, luminance))
        const sum = 0.6444632 * r + 1.1919203 * g + 1.2029166 * b
        expect((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / sum).toBeCloseTo(NIGHT.x, 4)
        expect(luminanceOf([r, g, b]) / sum).toBeCloseTo(NIGHT.y, 4)
      })
    )
  })

  it('darkens red and brightens blue of one luminance, the more the darker it is', () => {
    const ratio = (color: Color, luminance: number): number =>
      luminanceOf(seen(at(color, luminance))) / luminance
    // Larson et al.: V/Y of each primary over that of white.
    expect(ratio(RED, 1e-3)).toBeCloseTo((1.33 / 0.64 - 1.68) / 2.5729, 3)
    expect(ratio(GREEN, 1e-3)).toBeCloseTo((1.33 / 0.3 - 1.68) / 2.5729, 3)
    expect(ratio(BLUE, 1e-3)).toBeCloseTo((1.33 / 0.15 - 1.68) / 2.5729, 3)
    for (const luminance of [0.01, 0.1, 1]) {
      expect(ratio(RED, luminance)).toBeLessThan(ratio(RED, 3 * luminance))
      expect(ratio(BLUE, luminance)).toBeGreaterThan(ratio(BLUE, 3 * luminance))
    }
  })

  it('is continuous and halfway at the middle of the mesopic range', () => {
    const half = seen(at(WHITE, 0.005 * 10 ** 1.5))
    const all = seen(at(WHITE, 1e-3))
    const luminance = luminanceOf(half)
    for (const i of [0, 1, 2]) {
      expect(half[i] / luminance).toBeCloseTo((all[i] / luminanceOf(all) + 1) / 2, 3)
    }
    for (const edge of [0.005, 5]) {
      const [below, above] = [1 - 1e-6, 1 + 1e-6].map(part => seen(at([1, 0.6, 0.3], edge * part)))
      below.forEach((value, i) => expect(above[i] / value).toBeCloseTo(1, 4))
    }
  })

  it('turns sunlight that the moon reflects, warm by itself, bluish', () => {
    const moonlight = spectralToLinearSRGB(new AtmosphereParameters(), [0.7, 0.9, 1, 1.15])
    const [r, , b] = seen(at(moonlight, 0.01))
    expect(moonlight[0]).toBeGreaterThan(moonlight[2])
    expect(b).toBeGreaterThan(1.3 * r)
  })
})
