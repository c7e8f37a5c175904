import type { Place } from '../globe/places'

/** Places of the world that there are photographs of, and that of the local tiles. Heights above the ellipsoid. */
export const SIGHTS = {
  local: {
    label: 'Tennessee (local tiles)',
    longitude: -84.165,
    latitude: 36.49,
    height: 830,
    heading: 318,
    pitch: -9
  },
  manhattan: {
    label: 'Manhattan',
    longitude: -74.0205,
    latitude: 40.694,
    height: 320,
    heading: 33,
    pitch: -9
  },
  fuji: {
    label: 'Fuji',
    longitude: 138.792,
    latitude: 35.502,
    height: 2300,
    heading: 201,
    pitch: 1
  },
  london: {
    label: 'London',
    longitude: -0.1275,
    latitude: 51.4985,
    height: 260,
    heading: 62,
    pitch: -12
  }
} satisfies Record<string, Place>

export type SightName = keyof typeof SIGHTS
