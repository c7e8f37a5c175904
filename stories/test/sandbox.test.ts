import { AtmosphereParameters, marsParameters, titanParameters } from '@welkin/atmosphere'
import { describe, expect, it } from 'vitest'
import { randomSequence } from '../src/random'
import { airArgsOf, parametersOf } from '../src/sandbox/airArgs'
import type { AirArgs } from '../src/sandbox/airArgs'
import { airArgTypes } from '../src/sandbox/argTypes'
import { EARTH, presets } from '../src/sandbox/presets'
import type { PresetName } from '../src/sandbox/presets'

interface Range {
  min: number
  max: number
}

const ranges = Object.entries(airArgTypes).flatMap(([name, type]) => {
  const control = type.control as Range | 'boolean'
  return control === 'boolean' ? [] : [{ slider: name as keyof AirArgs, ...control }]
})

describe('sliders of the sandbox', () => {
  it.each(Object.keys(presets) as PresetName[])('hold the preset %s', name => {
    for (const { slider, min, max } of ranges) {
      const value = Number(presets[name][slider])
      expect({ slider, value, isHeld: value >= min && value <= max }).toMatchObject({
        isHeld: true
      })
    }
    expect(parametersOf(presets[name], EARTH).notes).toEqual([])
  })

  it('stand for the parameters that they were set to', () => {
    for (const parameters of [EARTH, marsParameters(), titanParameters()]) {
      const { init } = parametersOf(airArgsOf(parameters, EARTH), EARTH)
      for (const name of ['topRadius', 'rayleighScaleHeight', 'mieScaleHeight'] as const) {
        expect(init[name]! / parameters[name]).toBeCloseTo(1, 3)
      }
      for (const name of ['rayleighScattering', 'mieScattering', 'solarIrradiance'] as const) {
        init[name]!.forEach((value, i) => expect(value / parameters[name][i]).toBeCloseTo(1, 3))
      }
    }
  })

  it('are accepted wherever they are put', () => {
    const random = randomSequence(5)
    for (let i = 0; i < 500; i++) {
      const args = { ...presets.earth, standardLayers: random() < 0.5 }
      for (const { slider, min, max } of ranges) {
        const part = random()
        const [isLeast, isMost] = [part < 0.1, part > 0.9]
        const value = isLeast ? min : isMost ? max : min + (max - min) * random()
        Object.assign(args, { [slider]: value })
      }
      expect(() => new AtmosphereParameters(parametersOf(args, EARTH).init)).not.toThrow()
    }
  })

  it('set all that an atmosphere can be told, each of them something', () => {
    const { init } = parametersOf(presets.earth, EARTH)
    // Spectra have the wavelengths of the default.
    const fields = Object.keys(new AtmosphereParameters()).filter(
      name => name !== 'wavelengths' && name !== 'spectralToXYZ'
    )
    expect(Object.keys(init).toSorted()).toEqual(fields.toSorted())
    const dead = ranges.filter(({ slider, min, max }) => {
      const moved = { ...presets.earth, [slider]: presets.earth[slider] === min ? max : min }
      return JSON.stringify(parametersOf(moved, EARTH).init) === JSON.stringify(init)
    })
    expect(dead).toEqual([])
  })

  it('say what they move', () => {
    const { notes } = parametersOf({ ...presets.earth, radius: 1000, thickness: 800 }, EARTH)
    expect(notes).toEqual(['Thickness [m]: 800000 is shown as 499000'])
  })
})
