import type { CloudLayerParameters, CloudPrecipitation, CloudPresetName } from '@welkin/clouds'
import type { ValleyState } from '../../stories/src/valley/Valley'
import type { ValleyName } from '../../stories/src/valley/views'
import { falling } from './falling'
import { flashes } from './flashes'
import { optics } from './optics'
import { shafts } from './shafts'
import { streets, type StreetStill } from './streets'
import { terrains, type TerrainStill } from './terrains'

/** A still: what is in it, where the sun stands, and where the camera looks. */
export interface Still {
  name: string
  /** Features to look for. */
  about: string
  /** Preset of clouds; default: a clear sky. */
  clouds?: {
    preset: CloudPresetName
    coverage?: number
    precipitation?: CloudPrecipitation
    /** Other parameters of the first layer. */
    layer?: Partial<CloudLayerParameters>
  }
  /** Effective radius of the clouds' droplets [µm]; default: lobes of fair weather. */
  dropletRadius?: number
  /** Fog about the ground: extinction [1/m], altitude over which it falls to 1/e [m]; radius of its droplets [µm], default: a smooth phase function. */
  fog?: { density: number; falloff: number; dropletRadius?: number }
  /** A flash whose light the picture gathers: its kind, azimuth [°] and distance over the ground [m]. */
  lightning?: { kind: 'ground' | 'cloud'; azimuth: number; distance: number }
  /** Rain all about, in a layer that thins to 1/e over 250 m [mm/h]. */
  rain?: number
  /** Light shafts, of land and clouds, in the light of the sun or of the moon where there is one. */
  shafts?: true
  /** Shadow on the clouds of an aeroplane that the camera looks out of. Needs `shafts`. */
  aeroplane?: true
  /** Elevation and azimuth of a full moon, clockwise from north, whatever the date [°]. */
  moon?: { elevation: number; azimuth: number }
  /** Turbidity of the air; by default that of the standard Earth. */
  turbidity?: number
  planet?: 'mars'
  /** Place of the camera, default Tokyo [°], and its altitude above the ellipsoid [m]. */
  place?: { longitude: number; latitude: number }
  altitude: number
  /** Elevation and azimuth of the sun, clockwise from north [°]; or a date, which sets moon and stars too. */
  sun: { elevation: number; azimuth: number } | Date
  /** Azimuth, clockwise from north, and pitch of the camera [°]. */
  view: { azimuth: number; pitch: number }
  /** Vertical field of view [°]; default 55. */
  fieldOfView?: number
  /** Exposure over what is metered [EV]. */
  compensation?: number
  /** Hills and trees about the camera, the same under snow, towers and streets, or the bare planet. */
  land: 'hills' | 'snow' | 'ridge' | 'city' | 'planet'
}

/** A still of the story *Valley, all day*: a view, and what differs from how the story opens. */
export interface ValleyStill {
  name: string
  /** Features to look for. */
  about: string
  valley: { view: ValleyName } & Partial<ValleyState>
}

/** A still of any kind. */
export type AnyStill = Still | ValleyStill | TerrainStill | StreetStill

/** View of a preset. */
interface PresetView extends Pick<Still, 'place'> {
  azimuth: number
  pitch: number
  /** Altitude of the camera, default 2 [m]. */
  altitude?: number
}

/** The presets as they are, from the ground; fog from above. */
const presets: Record<CloudPresetName, PresetView> = {
  fairWeather: { azimuth: 330, pitch: 14 },
  stratocumulus: { azimuth: 30, pitch: 14 },
  overcast: { azimuth: 30, pitch: 10 },
  cumulonimbus: { azimuth: 20, pitch: 14, place: { longitude: 139.853, latitude: 35.845 } },
  congestus: { azimuth: 330, pitch: 14 },
  altocumulus: { azimuth: 30, pitch: 24 },
  cirrus: { azimuth: 20, pitch: 18 },
  mixed: { azimuth: 300, pitch: 14 },
  shower: { azimuth: 45, pitch: 12, place: { longitude: 139.853, latitude: 35.845 } },
  nimbostratus: { azimuth: 30, pitch: 7, place: { longitude: 22.3, latitude: 46.7 } },
  snowShower: { azimuth: 110, pitch: 9, place: { longitude: 20.3, latitude: 45.2 } },
  hailstorm: { azimuth: 20, pitch: 10, place: { longitude: 139.853, latitude: 35.845 } },
  fog: { azimuth: 30, pitch: -5, altitude: 750 }
}

/** Suns of the presets: elevation, and azimuth from where the camera looks [°]. */
const suns = {
  aside: { elevation: 42, turn: -80, about: 'form and shading, shadows on the hills' },
  behind: { elevation: 28, turn: 0, about: 'sun behind the clouds: silver linings, dark cores' },
  low: { elevation: 5, turn: 15, about: 'reddened light, long shadows in haze' },
  set: { elevation: -3, turn: 15, about: 'after sunset: only high clouds still have sun' }
}

const fromTheGround: Still[] = Object.entries(presets).flatMap(
  ([preset, { place, altitude = 2, ...view }]) =>
    Object.entries(suns).map(([name, { elevation, turn, about }]) => ({
      name: `${preset}-${name}`,
      about,
      clouds: { preset: preset as CloudPresetName },
      altitude,
      sun: { elevation, azimuth: (view.azimuth + turn + 360) % 360 },
      view,
      place,
      // Light of a low sun, or of one ahead, comes through much air, and not where clouds stand before it.
      shafts: elevation < 30 ? (true as const) : undefined,
      land: 'hills' as const
    }))
)

/** Rain, with the sun behind. */
const rainbows: Still[] = [
  {
    name: 'optics-rainbow',
    about:
      'red outside at 42°, violet inside, bright within; a fainter bow of 51°, reversed, the sky dark between them',
    rain: 8,
    altitude: 10,
    sun: { elevation: 14, azimuth: 180 },
    view: { azimuth: 0, pitch: 18 },
    land: 'hills'
  },
  {
    name: 'optics-moonbow',
    about: 'a full moon of 14° behind: the bow in a shaft of rain, pale and nearly white',
    clouds: { preset: 'shower', coverage: 0.15 },
    place: { longitude: 140.6798, latitude: 35.2496 },
    altitude: 60,
    sun: { elevation: -40, azimuth: 20 },
    moon: { elevation: 12, azimuth: 206 },
    compensation: 2,
    view: { azimuth: 60, pitch: 10 },
    land: 'hills'
  }
]

/** Halos of crystals, at a winter noon. */
const halos: Still[] = [
  {
    name: 'optics-halo',
    about:
      'thin cirrus about a sun of 22°: a ring of 22°, dark and sharp inside with a red edge, sun dogs at its sides',
    clouds: { preset: 'cirrus', coverage: 0.9 },
    dropletRadius: 10,
    altitude: 2,
    sun: { elevation: 22, azimuth: 20 },
    view: { azimuth: 20, pitch: 18 },
    land: 'snow'
  }
]

/** The valley, at hours and in weathers that differ much. */
const valleys: ValleyStill[] = [
  {
    name: 'valley-morning',
    about: 'mist over the lake, in the shadow of a mountain and in the sun',
    valley: { view: 'slope', hour: 7, weather: 'mist' }
  },
  {
    name: 'valley-day',
    about: 'village, forests in sun and shade of clouds, mountains in the lake',
    valley: { view: 'village', hour: 8 }
  },
  {
    name: 'valley-noon',
    about: 'the lake: waves, sky and mountains in it',
    valley: { view: 'shore', hour: 12 }
  },
  {
    name: 'valley-evening',
    about: 'the last sun on summits and clouds, and in the lake',
    valley: { view: 'shore', hour: 19 }
  },
  {
    name: 'valley-west',
    about: 'the sun goes behind the mountains across the lake, among broken clouds',
    valley: { view: 'west', hour: 18, weather: 'broken' }
  },
  {
    name: 'valley-night',
    about: 'windows of the village, moonlit mountains, stars: dark, not black',
    valley: { view: 'village', hour: 22.5, date: Date.UTC(2026, 8, 26) }
  },
  {
    name: 'valley-moonlight',
    about: 'a full moon high over winter: shadows of mountains, trees and clouds',
    valley: { view: 'slope', hour: 22, date: Date.UTC(2026, 11, 24), weather: 'broken' }
  },
  {
    name: 'valley-moonlit-village',
    about: 'the same before the village: shadows of houses and trees beside the lamps',
    valley: { view: 'village', hour: 23.5, date: Date.UTC(2026, 11, 24) }
  },
  {
    name: 'valley-finish',
    about: 'ambient occlusion about trees and houses',
    valley: { view: 'village', hour: 16, occlusion: true, motionBlur: true }
  },
  {
    name: 'valley-shower',
    about: 'a low sun behind: shafts of rain before mountains with a bow in them, wet ground',
    valley: { view: 'village', hour: 12.3, date: Date.UTC(2026, 10, 1), weather: 'shower' }
  },
  {
    name: 'valley-storm',
    about:
      'dark clouds over the valley in the afternoon, shafts of rain below them, wet ground and roofs',
    valley: { view: 'village', hour: 15, weather: 'storm' }
  },
  {
    name: 'valley-snow',
    about: 'snow on ground and roofs, flakes around the camera, mountains lost in what falls',
    valley: { view: 'village', hour: 11, date: Date.UTC(2026, 11, 19), weather: 'snow' }
  },
  {
    name: 'valley-above',
    about: 'over cumulus among snowy summits, the lake between them',
    valley: { view: 'above', hour: 9 }
  },
  {
    name: 'valley-effects',
    about: 'afternoon with all post effects on',
    valley: {
      view: 'village',
      hour: 16,
      occlusion: true,
      antialiasing: 'traa',
      depthOfField: true,
      motionBlur: true
    }
  },
  {
    name: 'valley-upscaled',
    about: 'morning, added up of frames with a quarter of the pixels',
    valley: { view: 'village', hour: 8, antialiasing: 'taau' }
  }
]

/** All stills, by name. */
export const stills: readonly AnyStill[] = [
  ...fromTheGround,
  ...shafts,
  ...optics,
  ...halos,
  ...rainbows,
  ...falling,
  ...valleys,
  ...terrains,
  ...streets,
  {
    name: 'among',
    about: 'among cumulus: edges near the camera, depth of the sky',
    clouds: { preset: 'fairWeather', coverage: 0.45 },
    altitude: 1500,
    sun: { elevation: 35, azimuth: 100 },
    view: { azimuth: 60, pitch: 0 },
    land: 'hills'
  },
  {
    name: 'among-towers',
    about: 'between the towers of a storm, sun aside',
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 139.571, latitude: 36.122 },
    altitude: 2500,
    sun: { elevation: 35, azimuth: 240 },
    view: { azimuth: 0, pitch: 14 },
    land: 'hills'
  },
  {
    name: '3km-deck',
    about: 'a deck from above, low sun: its texture, its far edge in haze',
    clouds: { preset: 'stratocumulus' },
    altitude: 3000,
    sun: { elevation: 18, azimuth: 60 },
    view: { azimuth: 30, pitch: -8 },
    land: 'hills'
  },
  {
    name: '10km-cumulus',
    about: 'from an airliner: cumulus and their shadows to the horizon',
    clouds: { preset: 'fairWeather', coverage: 0.45 },
    altitude: 10_500,
    sun: { elevation: 30, azimuth: 100 },
    view: { azimuth: 60, pitch: -12 },
    land: 'hills'
  },
  {
    name: '3km-storm',
    about:
      'a storm 30 km away: its base and tower aside, the underside of the anvil, cumulus below',
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 139.571, latitude: 35.965 },
    altitude: 3000,
    sun: { elevation: 35, azimuth: 280 },
    view: { azimuth: 0, pitch: 5 },
    land: 'planet'
  },
  {
    name: '10km-storm',
    about: 'from an airliner: a tower and its anvil aside, small cumulus below',
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 139.571, latitude: 35.995 },
    altitude: 7000,
    sun: { elevation: 35, azimuth: 280 },
    view: { azimuth: 0, pitch: -4 },
    land: 'planet'
  },
  {
    name: '100km',
    about: 'three layers from the edge of the air',
    clouds: { preset: 'mixed' },
    altitude: 100_000,
    sun: { elevation: 30, azimuth: 100 },
    view: { azimuth: 60, pitch: -14 },
    land: 'planet'
  },
  {
    name: '400km',
    about: 'three layers from orbit, limb in the picture',
    clouds: { preset: 'mixed' },
    altitude: 400_000,
    sun: { elevation: 25, azimuth: 100 },
    view: { azimuth: 60, pitch: -22 },
    land: 'planet'
  },
  {
    name: '400km-storms',
    about:
      'storms from orbit: anvils with fibres, tops with their shadows, small cumulus about them',
    clouds: { preset: 'cumulonimbus' },
    altitude: 400_000,
    sun: { elevation: 25, azimuth: 100 },
    view: { azimuth: 60, pitch: -32 },
    fieldOfView: 35,
    land: 'planet'
  },
  {
    name: '3000km',
    about: 'a fifth of the globe: clusters, bands, clear zones, no grain and no rows',
    clouds: { preset: 'mixed' },
    altitude: 3_000_000,
    sun: { elevation: 45, azimuth: 100 },
    view: { azimuth: 60, pitch: -60 },
    land: 'planet'
  },
  {
    name: '12000km',
    about: 'the globe: weather of a planet without a map of it',
    clouds: { preset: 'mixed' },
    altitude: 12_000_000,
    sun: { elevation: 55, azimuth: 100 },
    view: { azimuth: 60, pitch: -90 },
    land: 'planet'
  },
  {
    name: 'terminator',
    about: 'from day into night, 400 km up: the lit side keeps its shading, space is black',
    altitude: 400_000,
    sun: { elevation: -4, azimuth: 60 },
    view: { azimuth: 60, pitch: -22 },
    land: 'planet'
  },
  {
    name: 'clear-snow',
    about: 'snow at noon: pale, not burnt out',
    altitude: 2,
    sun: { elevation: 60, azimuth: 100 },
    view: { azimuth: 0, pitch: 0 },
    land: 'snow'
  },
  {
    name: 'clear-noon',
    about: 'blue of the zenith, pale horizon, haze before the hills',
    altitude: 2,
    sun: { elevation: 60, azimuth: 100 },
    view: { azimuth: 0, pitch: 5 },
    land: 'hills'
  },
  {
    name: 'clear-sunset',
    about: 'the reddened sun, 2° up',
    altitude: 300,
    sun: { elevation: 2, azimuth: 0 },
    view: { azimuth: 10, pitch: 2 },
    land: 'hills'
  },
  {
    name: 'clear-dusk',
    about: 'twilight arch with the sun 4° down',
    altitude: 300,
    sun: { elevation: -4, azimuth: 0 },
    view: { azimuth: 10, pitch: 8 },
    land: 'hills'
  },
  {
    name: 'night-moon',
    about: 'a day before full moon: moonlit clouds and hills, stars, Milky Way',
    clouds: { preset: 'fairWeather', coverage: 0.2 },
    altitude: 300,
    sun: new Date('2026-06-28T14:00:00Z'),
    view: { azimuth: 150, pitch: 18 },
    land: 'hills'
  },
  {
    name: 'night-stars',
    about: 'new moon: darker than by the moon, the Milky Way over black hills',
    altitude: 300,
    sun: new Date('2026-06-14T14:00:00Z'),
    view: { azimuth: 150, pitch: 18 },
    land: 'hills'
  },
  ...flashes,
  {
    name: 'mars-noon',
    about: 'butterscotch sky over red hills',
    planet: 'mars',
    altitude: 2,
    sun: { elevation: 50, azimuth: 100 },
    view: { azimuth: 0, pitch: 5 },
    land: 'hills'
  },
  {
    name: 'mars-sunset',
    about: 'blue glow about a setting sun',
    planet: 'mars',
    altitude: 2,
    sun: { elevation: 4, azimuth: 0 },
    view: { azimuth: 5, pitch: 6 },
    land: 'hills'
  }
]

/**
 * Stills by name, or by prefix where none has the name, in their own order; all for no words.
 *
 * @throws Error with the list if a word matches none.
 */
export function selectStills(words: readonly string[]): readonly AnyStill[] {
  if (words.length === 0) return stills
  const wanted = words.map(word => {
    const named = stills.filter(({ name }) => name === word)
    const found = named.length > 0 ? named : stills.filter(({ name }) => name.startsWith(word))
    if (found.length > 0) return found
    const names = stills.map(({ name }) => name).join(', ')
    throw new Error(`stills: no scene's name begins with '${word}'; there are ${names}`)
  })
  return stills.filter(still => wanted.some(found => found.includes(still)))
}
