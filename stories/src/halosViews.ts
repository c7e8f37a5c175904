import type { CloudLayerParameters, CloudPresetName } from '@welkin/clouds'

/** Vertical field of view by default [°]. */
export const FIELD_OF_VIEW = 62

/** A sky, and where the camera looks. */
export interface View {
  readonly label: string
  /** Null for mist or a shower about the ground. */
  readonly clouds: CloudPresetName | null
  /** True for a shower in place of mist. */
  readonly rains?: true
  /** Parameters of their layer that differ. */
  readonly layer?: Partial<CloudLayerParameters>
  /** Altitude of the camera [m]. */
  readonly altitude: number
  /** Pitch of the camera, which looks north [°]. */
  readonly pitch: number
  /** Vertical field of view [°]; by default `FIELD_OF_VIEW`. */
  readonly lens?: number
  /** Azimuth of the sun: behind the camera or before it [°]. */
  readonly azimuth: 0 | 180
  /** Elevation of the sun that it is made for [°]. */
  readonly sun: number
  /** Effective radius of its droplets [µm]; 9 if left out. */
  readonly dropletRadius?: number
  /** Exposure [stops]; 0 if left out. */
  readonly exposure?: number
}

/** The thinner a deck is, the more of its light is scattered once; the evener it is, the rounder are its rings. */
const evenDeck = { density: 0.004, shapeAmount: 0.25, edgeSoftness: 0.6, baseRelief: 0 }

/** Skies, and where the camera looks. */
export const VIEWS = {
  glory: {
    label: 'Glory on an even deck',
    clouds: 'overcast',
    layer: evenDeck,
    altitude: 2600,
    pitch: -38,
    lens: 18,
    azimuth: 180,
    sun: 38,
    dropletRadius: 8,
    exposure: -1
  },
  cloudbow: {
    label: 'Cloudbow about a glory',
    clouds: 'overcast',
    layer: evenDeck,
    altitude: 2600,
    pitch: -45,
    lens: 90,
    azimuth: 180,
    sun: 45,
    dropletRadius: 12,
    exposure: -0.75
  },
  fogbow: { label: 'Fogbow', clouds: null, altitude: 12, pitch: 12, azimuth: 180, sun: 15 },
  rainbow: {
    label: 'Rainbow',
    clouds: null,
    rains: true,
    altitude: 10,
    pitch: 18,
    azimuth: 180,
    sun: 14
  },
  halo: {
    label: 'Halo and sun dogs',
    clouds: 'cirrus',
    layer: { coverage: 0.9, density: 0.0015 },
    altitude: 2,
    pitch: 20,
    azimuth: 0,
    sun: 22,
    exposure: -1.5
  },
  corona: {
    label: 'Corona',
    clouds: 'altocumulus',
    layer: { coverage: 1, density: 0.0012, shapeAmount: 0.2, edgeSoftness: 0.8 },
    altitude: 2,
    pitch: 28,
    lens: 24,
    azimuth: 0,
    sun: 28,
    dropletRadius: 6,
    exposure: -5
  }
} as const satisfies Record<string, View>

/** Arguments of the story that a view sets. */
export const argsOf = ({ sun, dropletRadius = 9, exposure = 0 }: View) => ({
  sun,
  dropletRadius,
  exposure
})
