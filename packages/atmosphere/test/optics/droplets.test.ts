import { describe, expect, it } from 'vitest'
import { AtmosphereParameters, droplets, heightFog } from '@welkin/atmosphere'
import { encodePhases } from '../../scripts/optics/encodePhases'
import { mieAngles, mieSphere } from '../../scripts/optics/mieSphere'
import { waterIndex } from '../../scripts/optics/refraction'
import { whiteBalancedColumns } from '../../src/air/cpu/color'
import { colorSpectrum } from '../../src/optics/cpu/colorSpectrum'
import { decodePhases, LOG_STEPS } from '../../src/optics/cpu/decodePhases'
import { diffractedRow } from '../../src/optics/cpu/diffractedRow'
import { dropletRow } from '../../src/optics/cpu/dropletRow'
import { HALF_TEXELS, texelCosine } from '../../src/optics/cpu/phaseRow'
import { throwsEach, wrong } from '../harness/wrong'

const TEXELS = 2 * HALF_TEXELS
const toDegrees = 180 / Math.PI

/** Scattering angle of a texel [°]. */
const degrees = (texel: number): number => Math.acos(texelCosine(texel)) * toDegrees

/** Texel between two scattering angles [°] at which a figure is greatest. */
function greatest(from: number, to: number, figure: (texel: number) => number): number {
  const inside = Array.from({ length: TEXELS }, (_, i) => i).filter(
    i => degrees(i) >= from && degrees(i) <= to
  )
  return inside.reduce((best, i) => (figure(i) > figure(best) ? i : best), inside[0])
}

/** Integral over all directions, for each wavelength. */
function integrals(texels: Float32Array): number[] {
  return [0, 1, 2, 3].map(k => {
    let sum = 0
    for (let i = 1; i < TEXELS; i++) {
      const width = texelCosine(i - 1) - texelCosine(i)
      sum += Math.PI * width * (texels[4 * i + k] + texels[4 * i - 4 + k])
    }
    return sum
  })
}

/**
 * Angle between the primary bow and its first supernumerary [°]: Airy's rainbow integral has its maxima where Ai′ is 0 (Abramowitz & Stegun
 * 1964, table 10.13), at (θ₀ − θ) x^⅔ h^−⅓, h = (9/4) √((4 − n²)/(n² − 1)³) (van de Hulst 1957, §13.2).
 */
function airySpacing(radius: number, wavelength: number): number {
  const [first, second] = [1.018793, 3.248198]
  const square = 1.3336 ** 2
  const h = 2.25 * Math.sqrt((4 - square) / (square - 1) ** 3)
  const size = (2 * Math.PI * radius) / wavelength
  return (second - first) * Math.cbrt(h) * size ** (-2 / 3) * toDegrees
}

describe('Mie scattering', () => {
  it("is Rayleigh's for small spheres", () => {
    const x = 0.01
    const contrast = (1.33 ** 2 - 1) / (1.33 ** 2 + 2)
    const { efficiency, asymmetry } = mieSphere(x, 1.33, mieAngles([]))
    expect(efficiency / ((8 / 3) * x ** 4 * contrast ** 2)).toBeCloseTo(1, 3)
    expect(asymmetry).toBeCloseTo(0, 4)
  })

  it('scatters to all sides together what the series says, with its asymmetry', () => {
    const count = 3000
    const angles = mieAngles(Array.from({ length: count }, (_, i) => (2 * i + 1) / count - 1))
    const { efficiency, asymmetry } = mieSphere(12, 1.33, angles)
    let [all, forward] = [0, 0]
    angles.intensity.forEach((value, i) => {
      all += (4 / 12 ** 2 / count) * value
      forward += (4 / 12 ** 2 / count) * value * angles.cosines[i]
    })
    expect(all / efficiency).toBeCloseTo(1, 3)
    expect(forward / all).toBeCloseTo(asymmetry, 3)
  })

  it('takes twice its shadow from light if a sphere is large', () => {
    expect(mieSphere(3000, 1.33, mieAngles([])).efficiency).toBeCloseTo(2, 1)
  })

  it('has supernumerary bows as far inside the first as Airy’s theory', () => {
    const cosines = Array.from({ length: 900 }, (_, i) => -Math.cos((36 + i / 150) / toDegrees))
    const sum = cosines.map(() => 0)
    // Sizes that differ a little: their ripples cancel each other.
    const size = (2 * Math.PI * 500) / 0.55
    for (let k = -4; k <= 4; k++) {
      const angles = mieAngles(cosines)
      mieSphere(size * (1 + 0.003 * k), 1.3336, angles)
      angles.intensity.forEach((value, i) => (sum[i] += value))
    }
    const smooth = sum.map((_, i) => sum.slice(Math.max(i - 6, 0), i + 7).reduce((a, b) => a + b))
    const peak = (from: number, to: number): number =>
      smooth.slice(from, to).reduce((best, v, i, all) => (v > all[best] ? i : best), 0) + from
    const bow = peak(0, 900)
    const supernumerary = peak(bow - 150, bow - 70)
    expect((bow - supernumerary) / 150 / airySpacing(500, 0.55)).toBeCloseTo(1, 1)
  })

  // CRC Handbook of Chemistry and Physics: water at 20 °C against air, D line.
  it('has the refractive index of water', () => {
    expect(waterIndex(589.3, 293.15, 998.2)).toBeCloseTo(1.33299, 4)
  })
})

it.each([1, 2])(
  'stores phase functions to a step of their logarithms, colours to %d, steep ones too',
  colorStep => {
    const rows = [0, 1, 2].map(row =>
      Array.from({ length: 50 }, (_, i) =>
        [0, 1, 2].map(k => 10 ** (3 - (i * (row + 1)) / 9 + k / 7))
      )
    )
    const decoded = decodePhases(encodePhases(rows, colorStep), 50, colorStep)
    rows.flat(2).forEach((value, i) => {
      const most = (i % 3 === 1 ? 0.5001 : colorStep * 0.5001) / LOG_STEPS
      expect(Math.abs(Math.log2(decoded[i] / value))).toBeLessThanOrEqual(most)
    })
  }
)

it('gives sunlight at four wavelengths the colour that is asked for, white as it is', () => {
  const columns = whiteBalancedColumns(new AtmosphereParameters())
  for (const color of [
    [1, 1, 1],
    [1.4, 1, 0.7],
    [0.2, 0.3, 0.9]
  ] as const) {
    const spectrum = colorSpectrum(color)
    color.forEach((value, i) => {
      const seen = spectrum.reduce((sum, factor, k) => sum + factor * columns[k][i], 0)
      expect(seen).toBeCloseTo(value, 4)
    })
  }
  colorSpectrum([1, 1, 1]).forEach(factor => expect(factor).toBeCloseTo(1, 6))
})

describe('droplets', () => {
  const sizes = [3, 5, 8, 10, 14, 20, 30]

  it('scatter all light, and none of any wavelength below zero', () => {
    for (const radius of sizes) {
      const { texels } = dropletRow(radius)
      for (const sum of integrals(texels)) expect(Math.abs(sum - 1)).toBeLessThan(0.012)
      expect(Math.min(...texels)).toBeGreaterThan(0)
      // Blurred on the way, none is lost.
      for (const sum of integrals(diffractedRow(texels, radius))) {
        expect(Math.abs(sum - 1)).toBeLessThan(0.03)
      }
    }
  })

  it('are as asymmetric as the series says for the same sizes at 550 nm', () => {
    for (const effective of [5, 10, 20]) {
      let [section, forward] = [0, 0]
      for (let i = 0; i < 200; i++) {
        const r = effective * 0.2 * 12 ** (i / 199)
        const weight = r ** (22 + 1 + 2) * Math.exp(-r / (effective * 0.04))
        const { efficiency, asymmetry } = mieSphere((2 * Math.PI * r) / 0.55, waterIndex(550), {
          ...mieAngles([])
        })
        section += weight * efficiency
        forward += weight * efficiency * asymmetry
      }
      expect(Math.abs(dropletRow(effective).moments[0] - forward / section)).toBeLessThan(0.005)
    }
  })

  it('have a supernumerary bow inside the first, by Airy’s theory within a texel and the spread of sizes', () => {
    for (const radius of [16, 20, 25]) {
      const { texels } = dropletRow(radius)
      const green = (i: number): number => texels[4 * i + 2]
      const bow = 180 - degrees(greatest(130, 155, green))
      const spacing = airySpacing(radius, 0.55)
      const inside = greatest(180 - bow + 0.7 * spacing, 180 - bow + 1.3 * spacing, green)
      // A peak, not a slope.
      expect(green(inside)).toBeGreaterThan(Math.max(green(inside - 2), green(inside + 2)))
      expect(Math.abs(bow - (180 - degrees(inside)) - spacing)).toBeLessThan(0.8)
    }
  })

  // Greenler 1980, "Rainbows, halos, and glories": fogbows of about 35 to 40°, broad and nearly white.
  it('make a broad, nearly white bow, 35° to 40° from the point opposite the sun, wider for larger ones', () => {
    let [before, widthBefore] = [34, 16]
    for (const radius of sizes) {
      const { texels } = dropletRow(radius)
      const green = (i: number): number => texels[4 * i + 2]
      const bow = greatest(130, 155, green)
      const angle = 180 - degrees(bow)
      expect(angle).toBeGreaterThan(before)
      expect(angle).toBeLessThan(40.2)
      const four = [...texels.subarray(4 * bow, 4 * bow + 4)]
      expect(Math.max(...four) / Math.min(...four)).toBeLessThan(1.2)
      let [from, to] = [bow, bow]
      while (green(from) > 0.75 * green(bow)) from--
      while (green(to) > 0.75 * green(bow)) to++
      const width = degrees(to) - degrees(from)
      expect(width).toBeGreaterThan(1.5)
      expect(width).toBeLessThan(widthBefore)
      // Its outer edge, towards the sun, is red.
      if (radius >= 8) expect(texels[4 * from + 3]).toBeGreaterThan(1.05 * texels[4 * from])
      ;[before, widthBefore] = [angle, width]
    }
    expect(before).toBeGreaterThan(39)
  })

  it('make a glory, whose first red ring is as large as wavelength over droplet', () => {
    for (const radius of sizes.slice(0, -1)) {
      const { texels } = dropletRow(radius)
      const redness = (i: number): number => texels[4 * i + 3] / texels[4 * i]
      const ring = greatest(180 - 60 / radius, 180 - 12 / radius, redness)
      expect(redness(ring)).toBeGreaterThan(1.25)
      // α = 20° µm / r: x α of 2.9 to 3.6 for red light.
      expect((180 - degrees(ring)) * radius).toBeGreaterThan(18)
      expect((180 - degrees(ring)) * radius).toBeLessThan(22.5)
    }
  })

  // The first minimum of a disc's diffraction, sin θ = 1.22 λ/2r, takes blue from the aureole's edge.
  it('make a corona, whose aureole ends in red where blue light has its first minimum', () => {
    for (const radius of sizes.slice(1)) {
      const { texels } = dropletRow(radius)
      const redness = (i: number): number => texels[4 * i + 3] / texels[4 * i]
      const edge = greatest(8 / radius, 60 / radius, redness)
      const wavelength = ((degrees(edge) / toDegrees) * 2 * radius) / 1.22
      expect(redness(edge)).toBeGreaterThan(1.35)
      expect(wavelength).toBeGreaterThan(0.38)
      expect(wavelength).toBeLessThan(0.5)
    }
  })

  it('change with their radius, and fog with them', () => {
    const mist = droplets({ radius: 5 })
    const fog = heightFog({ droplets: mist })
    const [{ asymmetry }, { version }] = [mist, fog]
    mist.radius = 20
    expect(mist.asymmetry).toBeGreaterThan(asymmetry)
    expect(fog.version).toBeGreaterThan(version)
    expect(fog.droplets).toBe(mist)
    mist.dispose()
  })

  throwsEach('droplets', [
    ['Droplets: radius must be in [3, 30], got 2', () => droplets({ radius: 2 })],
    ["Droplets: unknown option 'size'", () => droplets(wrong({ size: 8 }))],
    [
      'HeightFog: droplets must be droplets() or null, got 8',
      () => heightFog({ droplets: wrong(8) })
    ]
  ])
})
