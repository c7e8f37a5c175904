import { describe, expect, it } from 'vitest'
import { AtmosphereParameters } from '@welkin/atmosphere'
import type { AtmosphereParametersInit, Spectrum } from '@welkin/atmosphere'

const bad: [AtmosphereParametersInit, RegExp][] = [
  [{ bottomRadius: -1 }, /AtmosphereParameters: bottomRadius .*-1/],
  [{ topRadius: 6_378_137 }, /AtmosphereParameters: topRadius .*6378137/],
  [{ topRadius: NaN }, /AtmosphereParameters: topRadius .*NaN/],
  [{ mieAsymmetry: 1 }, /AtmosphereParameters: mieAsymmetry.* got 1/],
  [{ rayleighScaleHeight: 0 }, /AtmosphereParameters: rayleighScaleHeight .*0/],
  [{ rayleighLayers: [[1e4, 0]] }, /AtmosphereParameters: rayleighLayers\[0\]\[1\] .* got 0/],
  [{ rayleighLayers: [[-1, 7e3]] }, /AtmosphereParameters: rayleighLayers\[0\]\[0\] .* got -1/],
  [
    {
      rayleighLayers: [
        [4e4, 7e3],
        [1e4, 6e3]
      ]
    },
    /AtmosphereParameters: rayleighLayers\[1\]\[0\] must be in \[40000, 1000000\], got 10000/
  ],
  [
    { rayleighLayers: [1, 2, 3, 4].map(i => [1e4 * i, 7e3] as const) },
    /AtmosphereParameters: rayleighLayers must be an array of at most 3 layers/
  ],
  [
    { rayleighLayers: [[1e4]] } as unknown as AtmosphereParametersInit,
    /AtmosphereParameters: rayleighLayers\[0\] .*2 values/
  ],
  [{ rayleighLayers: null as never }, /AtmosphereParameters: rayleighLayers .*3 layers.*null/],
  [{ groundAlbedo: [0, 0, 1.5, 0] }, /AtmosphereParameters: groundAlbedo\[2\] .*1\.5/],
  [
    { mieExtinction: [0, -1e-6, 0, 0] },
    /AtmosphereParameters: mieExtinction\[1\] .*-0\.000001|-1e-6/
  ],
  [
    { wavelengths: [1, 2, 3] as unknown as Spectrum },
    /AtmosphereParameters: wavelengths .*4 values.*3/
  ],
  [{ mieScattering: null as never }, /AtmosphereParameters: mieScattering .*4 values.*null/],
  [{ mieAsymmetry: null as never }, /AtmosphereParameters: mieAsymmetry .*null/],
  [
    { mieScaleHeight: '1200' } as unknown as AtmosphereParametersInit,
    /AtmosphereParameters: mieScaleHeight .*1200/
  ],
  [
    { groundAlbedo: ['0', 0, 0, 0] } as unknown as AtmosphereParametersInit,
    /AtmosphereParameters: groundAlbedo\[0\] .*0/
  ],
  [
    { groundAlbedo: 0.3 } as unknown as AtmosphereParametersInit,
    /AtmosphereParameters: groundAlbedo .*4 values.*0\.3/
  ],
  [{ albedo: 0.3 } as AtmosphereParametersInit, /AtmosphereParameters: .*albedo/],
  [{ toString: 0.3 } as unknown as AtmosphereParametersInit, /AtmosphereParameters: .*toString/],
  [
    { spectralToXYZ: [[0, 0, 0, 0]] } as unknown as AtmosphereParametersInit,
    /AtmosphereParameters: spectralToXYZ .*3 values/
  ],
  [
    { spectralToXYZ: [[0, 0, 0, 0], [0, 0, 0, 0], [0]] } as unknown as AtmosphereParametersInit,
    /AtmosphereParameters: spectralToXYZ\[2\] .*4 values/
  ],
  [{ bottomRadius: 7e6 }, /AtmosphereParameters: topRadius .*6438137/],
  [{ sunAngularRadius: Infinity }, /AtmosphereParameters: sunAngularRadius .*Infinity/],
  [
    {
      spectralToXYZ: [
        [NaN, 0, 0, 0],
        [0, 0, 0, 0],
        [0, 0, 0, 0]
      ]
    },
    /AtmosphereParameters: spectralToXYZ\[0\]\[0\] .*NaN/
  ]
]

describe('AtmosphereParameters', () => {
  it.each(bad)('names class, field and value of %j', (init, message) => {
    expect(() => new AtmosphereParameters(init)).toThrow(message)
    const parameters = new AtmosphereParameters()
    const before = parameters.clone()
    expect(() => parameters.set({ mieScaleHeight: 2000, ...init })).toThrow(message)
    expect(parameters.version).toBe(0)
    expect(parameters).toEqual(before)
  })

  it('counts changes', () => {
    const parameters = new AtmosphereParameters({ mieAsymmetry: 0.7 })
    expect(parameters.version).toBe(0)
    parameters.set({ mieAsymmetry: 0.6 })
    expect(parameters.version).toBe(1)
    expect(parameters.mieAsymmetry).toBe(0.6)
  })

  it('refuses aerosols that scatter more light than they take', () => {
    const parameters = new AtmosphereParameters()
    const { version } = parameters
    expect(() => parameters.set({ mieScattering: [0, 0, 0, 1e-5] })).toThrow(
      /mieScattering must be in \[0, 0\.0000044\d*\], got 0\.00001/
    )
    expect(parameters.version).toBe(version)
  })

  it('copies', () => {
    const parameters = new AtmosphereParameters({ mieAsymmetry: 0.7 })
    const copy = parameters.clone()
    parameters.set({ mieAsymmetry: 0.1 })
    expect(copy.mieAsymmetry).toBe(0.7)
    expect(copy.version).toBe(0)
  })

  it('shares no array with what it was made from, nor with its copies', () => {
    const groundAlbedo: [number, number, number, number] = [0.1, 0.2, 0.3, 0.4]
    const parameters = new AtmosphereParameters({ groundAlbedo })
    const copy = parameters.clone()
    expect(copy).toEqual(parameters)
    groundAlbedo[0] = 1
    expect(parameters.groundAlbedo[0]).toBe(0.1)
    const other = new AtmosphereParameters()
    for (const [name, value] of Object.entries(parameters)) {
      if (!Array.isArray(value)) continue
      expect(copy[name as keyof AtmosphereParameters]).not.toBe(value)
      expect(other[name as keyof AtmosphereParameters]).not.toBe(value)
    }
    expect(copy.spectralToXYZ[0]).not.toBe(parameters.spectralToXYZ[0])
  })

  it('makes the air of the Earth from turbidity and ozone', () => {
    const clear = new AtmosphereParameters({ turbidity: 1, ozone: 0 })
    expect(clear.mieExtinction).toEqual([0, 0, 0, 0])
    expect(clear.mieScattering).toEqual([0, 0, 0, 0])
    expect(clear.absorptionExtinction).toEqual([0, 0, 0, 0])
    const usual = new AtmosphereParameters()
    expect(new AtmosphereParameters().mieExtinction).toEqual(usual.mieExtinction)
    const hazy = new AtmosphereParameters({ turbidity: 6, ozone: 600 })
    hazy.mieExtinction.forEach((v, i) => expect(v / usual.mieExtinction[i]).toBeCloseTo(5, 9))
    hazy.absorptionExtinction.forEach((v, i) =>
      expect(v / usual.absorptionExtinction[i]).toBeCloseTo(2, 9)
    )
    expect(() => new AtmosphereParameters({ turbidity: 0.5 })).toThrow(
      /AtmosphereParameters: turbidity .*0\.5/
    )
    expect(() => new AtmosphereParameters({ ozone: NaN })).toThrow(
      /AtmosphereParameters: ozone .*NaN/
    )
  })

  it('changes nothing if one of turbidity and ozone is wrong', () => {
    const parameters = new AtmosphereParameters()
    expect(() => parameters.set({ turbidity: 5, ozone: -1 })).toThrow(/ozone .*-1/)
    expect(parameters.mieExtinction).toEqual(new AtmosphereParameters().mieExtinction)
  })
})
