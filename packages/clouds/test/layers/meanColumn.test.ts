import fc from 'fast-check'
import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { cloudPreset, cloudPresetNames } from '../../src'
import { layerRotation } from '../../src/density/lattice'
import { CloudLayer, type CloudLayerParameters } from '../../src/layers/CloudLayer'
import { strengthForm } from '../../src/density/formConstants'
import { densityAtHeight, meanColumn, neededStrength, seenShare } from '../../src/layers/meanColumn'
import { sampleLayer, weatherAt, type CloudState } from '../twins/density'
import type { NoiseName } from '../../src/noise/noiseSizes'
import type { Vec3Array } from '../twins/noise'
import { NoiseTextures } from '../twins/noiseTextures'

const bottomRadius = 6_360_000

/** Directions all over the planet: a spiral of even density. */
const directions = (count: number): Vector3[] =>
  Array.from({ length: count }, (_, i) => {
    const z = (2 * i + 1) / count - 1
    const [across, angle] = [Math.sqrt(1 - z * z), 2.399963 * i]
    return new Vector3(across * Math.cos(angle), across * Math.sin(angle), z)
  })

/** Columns without billows and turbulence: what they let through depends on the weather alone. */
const plain = { shapeAmount: 0, turbulence: 0, shear: 0 } as const

/** The weather alone: the shape's texels take float64 minutes. */
class WeatherAlone extends NoiseTextures {
  override sample(name: NoiseName, p: Vec3Array, level: number): number[] {
    return name === 'weather' ? super.sample(name, p, level) : [0.5, 0.5, 0.5, 0.5]
  }
}

const noise = new WeatherAlone()
const STEPS = 24

interface Sample {
  readonly height: number
  readonly strength: number
  readonly extinction: number
}

/** Samples of the float64 field, in columns where there are clouds. */
function cloudyColumns(parameters: CloudLayerParameters, count: number): Sample[][] {
  const state: CloudState = {
    layers: [parameters],
    rotations: [layerRotation(0)],
    bottomRadius,
    pixelAngle: 1e-3
  }
  const { baseAltitude, topAltitude } = parameters
  const sampleAt = (up: Vector3, height: number): Sample => {
    const altitude = baseAltitude + height * (topAltitude - baseAltitude)
    const place = up.clone().multiplyScalar(bottomRadius + altitude)
    return { height, ...sampleLayer(state, noise, 0, place, 10, false) }
  }
  const isCloudy = (up: Vector3): boolean => {
    const { sum, coverage } = weatherAt(state, noise, 0, up.clone().setLength(bottomRadius), 10)
    return 1 / (1 + Math.exp(-1.702 * sum)) > 1 - coverage
  }
  return directions(count)
    .filter(isCloudy)
    .map(up => Array.from({ length: STEPS }, (_, i) => sampleAt(up, (i + 0.5) / STEPS)))
}

describe('meanColumn', () => {
  it('lets as much light through as columns of the field do', () => {
    const layer = new CloudLayer({ ...plain, coverage: 0.5, density: 1 })
    // Extinction is in proportion to the density.
    const means = cloudyColumns(layer.parameters, 2000).map(samples =>
      samples.reduce((part, sample) => part + sample.extinction / STEPS, 0)
    )
    for (const [density, depthScale] of [
      [0.1, 1],
      [0.005, 1],
      [0.005, 0.4],
      [0.0005, 1]
    ]) {
      const { parameters } = new CloudLayer({ ...plain, coverage: 0.5, density })
      const passing = means.reduce(
        (sum, mean) => sum + Math.exp(-depthScale * 1200 * density * mean) / means.length,
        0
      )
      const { columnDensity } = meanColumn(parameters, depthScale)
      const expected = Math.exp(-density * 1200 * depthScale * columnDensity)
      expect(Math.abs(passing - expected), `${passing} for ${expected}`).toBeLessThan(0.02)
    }
  })

  it('sees tops, and nothing where no column reaches', () => {
    const { parameters } = new CloudLayer({ ...plain, coverage: 0.5 })
    const heights = Array.from({ length: 200 }, (_, i) => (i + 0.5) / 200)
    const shares = heights.map(height => seenShare(parameters, height))
    const mean = shares.reduce((sum, share) => sum + share) / heights.length
    expect(meanColumn(parameters).profileMean).toBeCloseTo(mean, 2)
    const middle = shares.indexOf(Math.max(...shares)) / heights.length
    expect(middle).toBeGreaterThan(0.3)
    expect(middle).toBeLessThan(0.8)
    for (const [i, height] of heights.entries()) {
      const isReached = neededStrength(parameters, height) < strengthForm.strongest
      expect(shares[i] > 0).toBe(isReached)
    }
  })

  it('stays within [0, 1], and its inside is denser, for any layer', () => {
    const share = fc.double({ min: 0, max: 1, noNaN: true })
    fc.assert(
      fc.property(share, share, share, share, share, (anvil, growth, soft, shape, exponent) => {
        const { parameters } = new CloudLayer({
          anvil,
          densityGrowth: 4 * growth,
          edgeSoftness: soft,
          shapeAmount: shape,
          profileExponent: 0.1 + 7.9 * exponent
        })
        for (const depthScale of [0.1, 1]) {
          const { columnDensity, insideDensity, profileMean } = meanColumn(parameters, depthScale)
          expect(columnDensity).toBeGreaterThanOrEqual(0)
          expect(columnDensity).toBeLessThanOrEqual(insideDensity + 1e-9)
          expect(insideDensity).toBeLessThanOrEqual(1)
          expect(profileMean).toBeGreaterThan(0)
          expect(profileMean).toBeLessThanOrEqual(1)
        }
      })
    )
  })
})

describe('functions of the height', () => {
  const parametersOf = (parameters: Partial<CloudLayerParameters>): CloudLayerParameters =>
    new CloudLayer(parameters).parameters

  it('need no strength at a flat base, and more with every metre above its relief where there is no anvil', () => {
    for (const name of cloudPresetNames) {
      const { parameters } = cloudPreset(name).at(0)
      const { anvil, baseRelief: lowest } = parameters
      if (lowest === 0) expect(neededStrength(parameters, 0)).toBeLessThan(0.05)
      if (anvil > 0) continue
      const heights = Array.from({ length: 50 }, (_, i) => lowest + (1 - lowest) * (i / 49))
      const needed = heights.map(height => neededStrength(parameters, height))
      expect(needed).toEqual(needed.toSorted((a, b) => a - b))
    }
  })

  it('raise the bases of weak columns where there is relief', () => {
    const layer = parametersOf({ baseRelief: 0.4 })
    const baseOf = (strength: number): number =>
      Array.from({ length: 400 }, (_, i) => i / 1000).find(
        height => neededStrength(layer, height) < strength
      )!
    const bases = [2, 3, 4, 5.5].map(baseOf)
    expect(bases).toEqual(bases.toSorted((a, b) => b - a))
    expect(bases[0]).toBeGreaterThan(0.1)
    expect(bases[3]).toBe(0)
    const flat = parametersOf({})
    expect(neededStrength(layer, 0.4)).toBe(neededStrength(flat, 0.4))
  })

  it('let towers spread into an anvil, below what overshoots', () => {
    const storm = parametersOf({ anvil: 1 })
    const [tower, anvil, top] = [0.25, 0.7, 1].map(height => neededStrength(storm, height))
    expect(anvil).toBeLessThan(tower / 3)
    expect(top).toBeGreaterThan(tower)
  })

  it('have extinction grow up to the middle as told, and ice thin', () => {
    const heights = [0.05, 0.2, 0.4, 0.5, 0.8, 1]
    const even = parametersOf({ densityGrowth: 0 })
    expect(heights.map(height => densityAtHeight(even, height))).toEqual([1, 1, 1, 1, 1, 1])
    const growing = heights.map(height =>
      densityAtHeight(parametersOf({ densityGrowth: 2 }), height)
    )
    expect(growing).toEqual(growing.toSorted((a, b) => a - b))
    expect(growing[0]).toBeLessThan(0.02)
    expect(growing[5]).toBe(1)
    const storm = parametersOf({ anvil: 1, densityGrowth: 0 })
    expect(densityAtHeight(storm, 0.9)).toBeLessThan(densityAtHeight(storm, 0.2) / 4)
  })
})
