import {
  airlessParameters,
  AtmosphereParameters,
  marsParameters,
  standardEarthParameters,
  titanParameters,
  venusParameters
} from '@welkin/atmosphere'
import { airArgsOf } from './airArgs'
import type { AirArgs } from './airArgs'

/** Default parameters, which the sun of every preset is measured by. */
export const EARTH = new AtmosphereParameters()

const earth = airArgsOf(EARTH, EARTH)
const of = (parameters: AtmosphereParameters): AirArgs => airArgsOf(parameters, EARTH)

/** Air and sun of each preset. */
export const presets = {
  earth,
  usualDay: of(standardEarthParameters()),
  haze: of(standardEarthParameters({ aerosolOpticalDepth: 0.8 })),
  withoutOzone: { ...earth, absorberAmount: 0 },
  mars: of(marsParameters()),
  dustStorm: of(marsParameters({ dust: 3 })),
  titan: of(titanParameters()),
  venus: of(venusParameters()),
  airless: of(airlessParameters()),
  smallPlanet: { ...earth, miniature: 400 },
  redDwarf: { ...earth, sunTemperature: 3000, sunRadius: 1.2, sunDistance: 0.9 }
} satisfies Record<string, AirArgs>

export type PresetName = keyof typeof presets

export const presetLabels: Record<PresetName, string> = {
  earth: 'Earth, clear air',
  usualDay: 'Earth, a usual day',
  haze: 'Earth, haze',
  withoutOzone: 'Earth without ozone',
  mars: 'Mars',
  dustStorm: 'Mars, dust storm',
  titan: 'Titan',
  venus: 'Venus above its clouds',
  airless: 'Moon, no air',
  smallPlanet: 'Small planet (16 km)',
  redDwarf: 'Earth at a red dwarf'
}
