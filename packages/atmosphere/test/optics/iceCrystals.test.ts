import { describe, expect, it } from 'vitest'
import { iceCrystals } from '@welkin/atmosphere'
import { haloBeams, slitPattern, spreadBeams } from '../../scripts/optics/beamDiffraction'
import { randomAxes, shadowArea, toCrystal, traceRay } from '../../scripts/optics/crystal'
import { iceIndex } from '../../scripts/optics/refraction'
import { crystalRows } from '../../src/optics/cpu/crystalRows'
import { HALF_TEXELS, texelCosine } from '../../src/optics/cpu/phaseRow'
import { dogAzimuth, leastDogAzimuth } from '../../scripts/optics/sunDogs'
import { DOG_ELEVATIONS } from '../../src/optics/cpu/sunDogs'
import { throwsEach, wrong } from '../harness/wrong'

const TEXELS = 2 * HALF_TEXELS
const toDegrees = 180 / Math.PI
const degrees = Array.from({ length: TEXELS }, (_, i) => Math.acos(texelCosine(i)) * toDegrees)

/** Numbers in [0, 1), the same in every run. */
function numbers(): () => number {
  let state = 7
  return () => (state = (state * 1664525 + 1013904223) % 4294967296) / 4294967296
}

const dot = (a: readonly number[], b: readonly number[]): number =>
  a.reduce((sum, value, i) => sum + value * b[i], 0)

describe('rays through prisms', () => {
  it('have a mean shadow of a quarter of the surface (Cauchy)', () => {
    const random = numbers()
    for (const halfLength of [0.1, 1, 3]) {
      const surface = 12 * halfLength + 3 * Math.sqrt(3)
      let sum = 0
      for (let i = 0; i < 40_000; i++) {
        sum += shadowArea({ halfLength }, toCrystal(randomAxes(random), [0, 0, 1]))
      }
      expect(sum / 40_000 / (surface / 4)).toBeCloseTo(1, 1.7)
    }
  })

  it('keep their length, and through sides of 60° turn by the least deviation or more', () => {
    const random = numbers()
    const index = iceIndex(550)
    const least = 2 * Math.asin(index / 2) * toDegrees - 60
    let [before, after] = [0, 0]
    for (let i = 0; i < 60_000; i++) {
      const direction = toCrystal(randomAxes(random), [0, 0, 1])
      const out = traceRay({ halfLength: 2 }, index, direction, random)
      expect(Math.hypot(...out)).toBeCloseTo(1, 6)
      const angle = Math.acos(Math.min(dot(out, direction), 1)) * toDegrees
      if (angle > least - 2 && angle < least - 0.05) before++
      if (angle > least && angle < least + 2) after++
    }
    expect(after).toBeGreaterThan(10 * before)
  })
})

describe('beams that leave prisms', () => {
  it('spread as light behind a slit: half at 0.443 λ/b, nothing at λ/b, all together 1', () => {
    const beams = [{ width: 25, share: 1 }]
    const at = (radians: number): number => slitPattern(beams, radians, 0.55)
    expect(at(Math.asin((0.443 * 0.55) / 25)) / at(0)).toBeCloseTo(0.5, 3)
    expect(at(Math.asin(0.55 / 25)) / at(0)).toBeCloseTo(0, 9)
    let sum = 0
    for (let i = -40_000; i <= 40_000; i++) sum += at(i * 2e-5) * 2e-5
    expect(sum).toBeCloseTo(1, 2)
  })

  it('are narrower than the discs that have the shadows of their crystals, and have all of the light', () => {
    const beams = haloBeams([{ halfLength: 2 }, { halfLength: 0.1 }])
    expect(beams.reduce((sum, { share }) => sum + share, 0)).toBeCloseTo(1, 12)
    // Columns have twice as much of their surface in sides, and more.
    expect(beams[0].share).toBeGreaterThan(2 * beams[1].share)
    expect(Math.min(...beams.map(({ width }) => width))).toBeGreaterThan(9)
    expect(Math.max(...beams.map(({ width }) => width))).toBeLessThan(160)
  })

  it('keep the light of a ring, and none goes where none may', () => {
    const sine = (i: number): number => Math.sin((i * Math.PI) / 1800)
    const ring = Array.from({ length: 901 }, (_, i) => (i >= 300 && i < 320 ? 1 : 0))
    const spread = spreadBeams(ring, 12, [{ width: 25, share: 1 }], 0.55)
    const light = (phase: readonly number[]): number =>
      phase.reduce((sum, value, i) => sum + value * sine(i), 0)
    expect(light(spread) / light(ring)).toBeCloseTo(1, 3)
    expect(Math.max(...spread.slice(0, 120))).toBe(0)
    expect(spread[310]).toBeLessThan(0.95)
  })
})

// Greenler 1980, "Rainbows, halos, and glories", ch. 2: halos of 22° and 46° with red inner edges, sun dogs at the sun's height.
describe('crystals', () => {
  const { texels } = crystalRows(1, 1)
  const all = texels.subarray(0, 4 * TEXELS)
  const rough = crystalRows(0, 0).texels.subarray(0, 4 * TEXELS)
  const near = (angle: number): number => degrees.findIndex(value => value >= angle)
  const at = (row: Float32Array, angle: number, wave: number): number => row[4 * near(angle) + wave]

  it('scatter all light, with flat faces and with rough ones', () => {
    for (const row of [all, rough]) {
      for (let k = 0; k < 4; k++) {
        let sum = 0
        for (let i = 1; i < TEXELS; i++) {
          const width = texelCosine(i - 1) - texelCosine(i)
          sum += Math.PI * width * (row[4 * i + k] + row[4 * i - 4 + k])
        }
        expect(Math.abs(sum - 1)).toBeLessThan(0.06)
      }
    }
  })

  it('make a halo of 22° with a dark inside and a red inner edge, and a faint one of 46°', () => {
    expect(at(all, 22.6, 1) / at(all, 20.5, 1)).toBeGreaterThan(8)
    expect(at(all, 24, 1)).toBeGreaterThan(1.5 * at(all, 27, 1))
    for (const [edge, least] of [
      [21.8, 1.6],
      [45.7, 1.5]
    ]) {
      expect(at(all, edge, 3) / at(all, edge, 0)).toBeGreaterThan(least)
    }
    expect(at(all, 47, 1) / at(all, 44, 1)).toBeGreaterThan(1.3)
    expect(at(all, 22.6, 1) / at(all, 47, 1)).toBeGreaterThan(5)
    // Crystals of tens of micrometres spread the edge by a degree and more; the sun's disc alone, by half of one.
    const [inside, peak] = [at(all, 19, 2), at(all, 22.7, 2)]
    const [low, high] = [0.1, 0.9].map(part =>
      degrees.find((_, i) => i > near(19) && all[4 * i + 2] > inside + part * (peak - inside))
    ) as [number, number]
    expect(high - low).toBeGreaterThan(1.1)
    expect(high - low).toBeLessThan(2)
    // Rough ones have none.
    expect(at(rough, 22.6, 1) / at(rough, 20, 1)).toBeLessThan(1)
  })

  it('make sun dogs, red inside, at 22° for a low sun and farther out for a high one', () => {
    expect(leastDogAzimuth(0)).toBeCloseTo(2 * Math.asin(1.3075 / 2) * toDegrees - 60, 9)
    // Tape 1994, "Atmospheric halos": 22° at the horizon, 28° along the parhelic circle at 30°, 51° at 50°, none above 61°.
    expect(leastDogAzimuth(30)).toBeCloseTo(28.4, 0)
    expect(leastDogAzimuth(50)).toBeCloseTo(51, 0)
    DOG_ELEVATIONS.slice(0, 5).forEach((elevation, n) => {
      const row = texels.subarray(4 * TEXELS * (n + 1), 4 * TEXELS * (n + 2))
      const value = (offset: number, wave: number): number =>
        row[4 * Math.round(dogAzimuth.inverse(offset) * (TEXELS - 1)) + wave]
      expect(value(0.8, 2)).toBeGreaterThan(5 * value(-1, 2))
      expect(value(0.8, 2)).toBeGreaterThan(2 * value(6, 2))
      expect(value(0, 3)).toBeGreaterThan(1.5 * value(0, 0))
      expect(value(3, 3)).toBeLessThan(value(3, 0))
      expect(elevation).toBe(10 * n)
    })
    expect(dogAzimuth.inverse(-3)).toBe(-1)
    for (const part of [0, 0.3, 1]) {
      expect(dogAzimuth.inverse(dogAzimuth.at(part))).toBeCloseTo(part, 9)
    }
  })

  throwsEach('crystals', [
    ['IceCrystals: regular must be in [0, 1], got 2', () => iceCrystals({ regular: 2 })],
    ['IceCrystals: level must be in [0, 1], got NaN', () => iceCrystals({ level: NaN })],
    ["IceCrystals: unknown option 'plates'", () => iceCrystals(wrong({ plates: 1 }))]
  ])

  it('count changes', () => {
    const crystals = iceCrystals()
    expect(crystals.set({ level: 1, regular: 0.2 }).version).toBe(2)
    expect(crystals.asymmetry).toBeGreaterThan(0.75)
    expect(crystals.asymmetry).toBeLessThan(0.9)
    crystals.dispose()
  })
})
