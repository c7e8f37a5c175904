import type { CloudLayerParameters, CloudPrecipitation, CloudPresetName } from '@welkin/clouds'

/** Vertical field of view [°]. */
export const FIELD_OF_VIEW = 62

/** Arguments of the story that a view sets. */
interface ViewArgs {
  /** Elevation of the sun [°]. */
  readonly sun: number
  /** [mm/h] */
  readonly rate: number
  readonly virgaDepth: number
  readonly freezingLevel: number
  /** [stops] */
  readonly exposure: number
}

const summer = { virgaDepth: 0, freezingLevel: 2300, exposure: 0 }

/** A weather, and where the camera looks. */
export interface View {
  readonly label: string
  readonly clouds: CloudPresetName
  /** Share of the sky that the first layer covers. */
  readonly coverage: number
  /** Other parameters of that layer, where the preset's are not meant. */
  readonly layer?: Partial<CloudLayerParameters>
  /** Other parameters of what falls. */
  readonly fall?: Partial<CloudPrecipitation>
  /** Azimuth of the sun, clockwise from north [°]. */
  readonly azimuth: number
  /** Azimuth that the camera looks to, clockwise from north [°]. */
  readonly heading: number
  /** Pitch of the camera [°]. */
  readonly pitch: number
  /** Sun, fall and exposure that it is made for. */
  readonly args: ViewArgs
  /** Place of the camera [°]. */
  readonly place: { readonly longitude: number; readonly latitude: number }
}

/** Elevation of the sun behind the camera of the bow [°]: the top of the arc stands at what is left to 42°. */
export const BOW_SUN = 29

/** West of a lone shower. */
const besideShower = { longitude: 140.6426, latitude: 35.2626 }

/** Weathers, and where the camera looks. */
export const VIEWS = {
  shower: {
    label: 'Shower',
    args: { ...summer, sun: 30, rate: 12 },
    clouds: 'shower',
    coverage: 0.2,
    layer: { baseAltitude: 1500 },
    azimuth: 180,
    heading: 90,
    pitch: 10,
    place: besideShower
  },
  bow: {
    label: 'Bow in a shower',
    args: { ...summer, sun: BOW_SUN, rate: 8, exposure: -0.5 },
    clouds: 'shower',
    fall: { streaks: 1 },
    coverage: 0.2,
    layer: { baseAltitude: 1500 },
    azimuth: 270,
    heading: 90,
    pitch: 10,
    place: besideShower
  },
  virga: {
    label: 'Virga',
    args: { sun: 6, rate: 4, virgaDepth: 900, freezingLevel: 0, exposure: 0 },
    clouds: 'altocumulus',
    coverage: 0.12,
    layer: {
      topAltitude: 4400,
      density: 0.006,
      weatherScale: 0.6,
      shapeScale: 0.8,
      wind: { east: 9, north: -2 }
    },
    azimuth: 290,
    heading: 340,
    pitch: 16,
    fall: { share: 0.9, streaks: 2 },
    place: { longitude: 20.6, latitude: 45.6 }
  },
  snow: {
    label: 'Snow shower',
    args: { ...summer, sun: 18, rate: 1.5, freezingLevel: 0 },
    clouds: 'snowShower',
    coverage: 0.1,
    azimuth: 280,
    heading: 20,
    pitch: 9,
    place: { longitude: 20, latitude: 45 }
  }
} as const satisfies Record<string, View>
