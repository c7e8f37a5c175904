import type { CloudPresetName } from '@welkin/clouds'

/** A view of shafts: what casts them, where their light stands, and where the camera looks. */
export interface ShaftView {
  readonly label: string
  /** Features to look for. */
  readonly about: string
  /** Preset of clouds; left out, a clear sky. */
  readonly clouds?: { readonly preset: CloudPresetName; readonly coverage?: number }
  /** Fog about the ground: extinction [1/m], altitude over which it falls to 1/e [m]. */
  readonly fog?: { readonly density: number; readonly falloff: number }
  /** Place on the Earth, default Tokyo [°], and altitude above the ellipsoid [m]. */
  readonly place?: { readonly longitude: number; readonly latitude: number }
  readonly altitude: number
  /** Turbidity of the air. */
  readonly turbidity: number
  /** Elevation and azimuth of the sun, or of the full moon, clockwise from north [°]. */
  readonly light: { readonly elevation: number; readonly azimuth: number }
  readonly isMoonlit?: true
  /** Azimuth, clockwise from north, and pitch of the camera [°]. */
  readonly view: { readonly azimuth: number; readonly pitch: number }
  /** Hills and trees, a ridge with spruces before which one stands, towers and streets, or the bare planet. */
  readonly land: 'hills' | 'ridge' | 'city' | 'planet'
}

/** Views of the story *Light shafts*, which the stills of the same names draw at full size. */
export const shaftViews = {
  deck: {
    label: 'Below a broken deck',
    about:
      "a broken deck under a sun of 20°: Jacob's ladder below it, no bands, no halo at edges of clouds",
    clouds: { preset: 'stratocumulus', coverage: 0.6 },
    place: { longitude: 140.81, latitude: 35.68 },
    turbidity: 12,
    light: { elevation: 20, azimuth: 30 },
    view: { azimuth: 34, pitch: 12 },
    altitude: 2,
    land: 'hills'
  },
  ridge: {
    label: 'Ridge at sunrise',
    about:
      'the sun between spruces on a ridge, 9° up: rays between their shadows fan out from there in the valley fog',
    fog: { density: 0.004, falloff: 70 },
    turbidity: 3,
    light: { elevation: 8.6, azimuth: 152 },
    view: { azimuth: 161, pitch: 6.5 },
    altitude: 12,
    land: 'ridge'
  },
  towers: {
    label: 'Towers in haze',
    about:
      'the sun of 11° down a street, in haze: bright where it comes between the towers, dark behind each',
    fog: { density: 0.002, falloff: 120 },
    turbidity: 6,
    light: { elevation: 11, azimuth: 250 },
    view: { azimuth: 248, pitch: 2 },
    altitude: 30,
    land: 'city'
  },
  storm: {
    label: "Storm's shadow from 9 km",
    about: "a storm's shadow on its own anvil's haze and on the air below, from 9 km",
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 139.571, latitude: 35.995 },
    turbidity: 3,
    light: { elevation: 9, azimuth: 20 },
    view: { azimuth: 0, pitch: -3 },
    altitude: 9000,
    land: 'planet'
  },
  opposite: {
    label: 'Anticrepuscular rays',
    about:
      'shadows of storms behind the camera, opposite a sunset of 2°: rays that run together at the horizon over the sea',
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 139.571, latitude: 35.995 },
    turbidity: 4,
    light: { elevation: 2, azimuth: 10 },
    view: { azimuth: 190, pitch: 8 },
    altitude: 400,
    land: 'planet'
  },
  moonlight: {
    label: 'Moonlight',
    about: 'moonlight through the gaps of a deck: the rays of the deck, by night',
    clouds: { preset: 'stratocumulus', coverage: 0.6 },
    place: { longitude: 140.81, latitude: 35.68 },
    turbidity: 6,
    light: { elevation: 22, azimuth: 30 },
    isMoonlit: true,
    view: { azimuth: 34, pitch: 13 },
    altitude: 2,
    land: 'hills'
  }
} satisfies Record<string, ShaftView>

export type ShaftViewName = keyof typeof shaftViews

/** Air and light of a view, as its still has them. */
export function argsOf(name: ShaftViewName) {
  const { turbidity, light }: ShaftView = shaftViews[name]
  return { turbidity, ...light }
}

/** Text that is the same for views of one scene: with the same land, clouds, fog and source of light. */
export function sceneOf(name: ShaftViewName): string {
  const { land, clouds, fog, isMoonlit }: ShaftView = shaftViews[name]
  return JSON.stringify([land, clouds, fog, isMoonlit])
}
