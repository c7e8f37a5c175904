import type { ArgTypes } from '@storybook/html-vite'
import { WAVELENGTHS } from './airArgs'
import type { AirArgs, SpectrumName } from './airArgs'

/** Slider of a story's controls. */
export const slider = (
  category: string,
  name: string,
  [min, max, step]: readonly [number, number, number],
  description: string
) => ({
  name,
  description,
  control: { type: 'range' as const, min, max, step },
  table: { category }
})

/** Sliders of a spectrum, one for each wavelength. */
function spectrum(
  category: string,
  key: SpectrumName,
  name: string,
  unit: string,
  range: readonly [number, number, number],
  description: string
): ArgTypes {
  return Object.fromEntries(
    WAVELENGTHS.map(nm => {
      const type = slider(category, `${name}, ${nm} nm${unit}`, range, description)
      return [`${key}${nm}`, { ...type, table: { category, subcategory: `${name}${unit}` } }]
    })
  )
}

const [molecules, aerosols, absorber, planet, sun] = [
  'Molecules',
  'Aerosols',
  'Absorber (ozone)',
  'Planet',
  'Sun'
]
const amount = [0, 20, 0.05] as const
const part = [0, 1, 0.005] as const

/** Controls of air and sun. */
export const airArgTypes: Partial<ArgTypes<AirArgs>> = {
  moleculesAmount: slider(molecules, 'Amount', amount, 'Factor on scattering at all wavelengths'),
  moleculesHeight: slider(
    molecules,
    'Scale height [km]',
    [0.1, 60, 0.1],
    'Altitude in which density falls to 37 %'
  ),
  standardLayers: {
    name: 'Standard Atmosphere',
    description: 'Scale heights of the U.S. Standard Atmosphere 1976 from 9.8 km upward',
    control: 'boolean',
    table: { category: molecules }
  },
  ...spectrum(
    molecules,
    'molecules',
    'Scattering',
    ' [1/Mm]',
    [0, 200, 0.1],
    'At the ground, per 1000 km'
  ),
  aerosolsAmount: slider(aerosols, 'Amount', amount, 'Factor on extinction at all wavelengths'),
  aerosolsHeight: slider(
    aerosols,
    'Scale height [km]',
    [0.1, 100, 0.1],
    'Altitude in which density falls to 37 %'
  ),
  ...spectrum(
    aerosols,
    'aerosols',
    'Extinction',
    ' [1/Mm]',
    [0, 1000, 0.1],
    'Scattering and absorption at the ground, per 1000 km'
  ),
  ...spectrum(
    aerosols,
    'aerosolAlbedo',
    'Scattered part',
    '',
    part,
    'Part of extinction that is scattering; the rest is absorbed'
  ),
  ...spectrum(
    aerosols,
    'asymmetry',
    'Asymmetry g',
    '',
    [-0.95, 0.95, 0.01],
    '0 scatters evenly, 0.8 ahead, below 0 back to the sun'
  ),
  absorberAmount: slider(absorber, 'Amount', amount, 'Factor on absorption; 1 is 300 Dobson units'),
  absorberAltitude: slider(absorber, 'Altitude [km]', [0, 100, 0.5], "Of the layer's middle"),
  absorberHalfWidth: slider(
    absorber,
    'Half width [km]',
    [0.5, 60, 0.5],
    'Distance from the middle at which the layer ends'
  ),
  ...spectrum(
    absorber,
    'absorber',
    'Absorption',
    ' [1/Mm]',
    [0, 50, 0.01],
    'In the middle of the layer, per 1000 km'
  ),
  radius: slider(planet, 'Radius [km]', [100, 12_000, 1], 'Centre to ground, before Miniature'),
  thickness: slider(planet, 'Thickness [km]', [1, 800, 1], 'Ground to the top of the air'),
  miniature: slider(
    planet,
    'Miniature',
    [1, 1000, 1],
    'Small planet with the same sky: divides its lengths, multiplies scattering and absorption'
  ),
  ...spectrum(planet, 'ground', "Ground's albedo", '', part, 'Part of light that it reflects'),
  sunDistance: slider(sun, 'Distance [au]', [0.2, 10, 0.01], 'Brightness falls by its square'),
  sunTemperature: slider(
    sun,
    'Temperature [K]',
    [2000, 20_000, 50],
    'Colour of the star, at the same brightness of green light'
  ),
  sunRadius: slider(sun, 'Angular radius [°]', [0.02, 5, 0.01], "Of the sun's disc"),
  limbDarkening: slider(sun, 'Limb darkening', part, '1 is that of our sun, 0 an even disc')
}
