import { describe, expect, it } from 'vitest'
import { CloudLayer, CloudLayers, cloudPreset, type CloudLayerParameters } from '../../src'

const invalid: [Partial<CloudLayerParameters>, RegExp][] = [
  [{ baseAltitude: -1 }, /baseAltitude must be .* got -1/],
  [{ baseAltitude: 3000, topAltitude: 2000 }, /topAltitude must be above .*3000 m.* got 2000/],
  [{ topAltitude: 1e6 }, /topAltitude must be .* got 1000000/],
  [{ coverage: 1.2 }, /coverage must be .* got 1.2/],
  [{ density: NaN }, /density must be .* got NaN/],
  [{ profileExponent: 0 }, /profileExponent must be .* got 0/],
  [{ weatherScale: 0 }, /weatherScale must be .* got 0/],
  [{ shapeScale: 11 }, /shapeScale must be .* got 11/],
  [{ detailScale: 0.05 }, /detailScale must be .* got 0.05/],
  [{ edgeSoftness: 2 }, /edgeSoftness must be .* got 2/],
  [{ turbulence: -1 }, /turbulence must be .* got -1/],
  [{ shear: 6 }, /shear must be .* got 6/],
  [{ shear: NaN }, /shear must be .* got NaN/],
  [{ anvil: 1.5 }, /anvil must be .* got 1.5/],
  [{ openCells: -0.5 }, /openCells must be .* got -0.5/],
  [{ densityGrowth: 5 }, /densityGrowth must be .* got 5/],
  [{ weatherWeights: [0, 0, 0, 2] }, /weatherWeights\[3\] must be .* got 2/],
  [
    { weatherWeights: [0, 0] as never },
    /weatherWeights must be an array of 4 values, got \[0, 0\]/
  ],
  [{ wind: { east: Infinity, north: 0 } }, /wind.east must be .* got Infinity/],
  [{ shadow: 1 as never }, /shadow must be true or false, got 1/],
  [{ covrage: 1 } as never, /CloudLayer: unknown option 'covrage', did you mean 'coverage'\?/]
]

describe('CloudLayer', () => {
  it.for(invalid)('rejects %o', ([parameters, message]) => {
    expect(() => new CloudLayer(parameters)).toThrow(message)
  })

  it('stays as it was when a change is not valid', () => {
    const layer = new CloudLayer({ coverage: 0.5 })
    expect(() => layer.set({ coverage: 2 })).toThrow(/coverage/)
    expect(layer.parameters.coverage).toBe(0.5)
    expect(layer.set({ coverage: 0.7 }).parameters.coverage).toBe(0.7)
  })

  it('does not share arrays with its caller or its clone', () => {
    const weatherWeights: [number, number, number, number] = [1, 0, 0, 0]
    const layer = new CloudLayer({ weatherWeights })
    weatherWeights[0] = 0.25
    const clone = layer.clone().set({ coverage: 0.9 })
    expect(layer.parameters.weatherWeights[0]).toBe(1)
    expect(layer.parameters.coverage).not.toBe(clone.parameters.coverage)
  })
})

describe('CloudLayers', () => {
  it('holds one to four layers', () => {
    expect(new CloudLayers().length).toBe(1)
    expect([...new CloudLayers([{}, {}, {}, {}])]).toHaveLength(4)
    expect(() => new CloudLayers([])).toThrow(/1 to 4, got 0/)
    expect(() => new CloudLayers([{}, {}, {}, {}, {}])).toThrow(/1 to 4, got 5/)
  })

  it('keeps the layers that it is given', () => {
    const layer = new CloudLayer()
    expect(new CloudLayers([layer]).at(0)).toBe(layer)
    expect(() => new CloudLayers([layer]).at(1)).toThrow(/got 1/)
  })

  it('takes the parameters of others, and clears what is left over', () => {
    const layers = cloudPreset('mixed', 4)
    expect(layers.length).toBe(4)
    expect(layers.at(3).parameters.coverage).toBe(0)
    const first = layers.at(0)
    layers.copy(cloudPreset('overcast'))
    expect(layers.at(0)).toBe(first)
    expect(first.parameters).toEqual(cloudPreset('overcast').at(0).parameters)
    expect([...layers].map(({ parameters }) => parameters.coverage)).toEqual([1, 0, 0, 0])
    layers.copy(cloudPreset('cumulonimbus'))
    expect(layers.at(1).parameters).toEqual(cloudPreset('cumulonimbus').at(1).parameters)
    expect(() => cloudPreset('cirrus', 2).copy(cloudPreset('mixed'))).toThrow(
      'CloudLayers: layers must be 1 to 2, got 3'
    )
    expect(() => cloudPreset('cirrus', 5)).toThrow('cloudPreset: count must be 0 to 4, got 5')
    expect(new CloudLayers([{}, {}, {}], 2).length).toBe(3)
  })
})
