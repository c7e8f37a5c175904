import { halos, rainbows } from './bows'
import { falling } from './falling'
import { flashes } from './flashes'
import { optics } from './optics'
import { fromTheGround } from './presets'
import { shafts } from './shafts'
import { sheet } from './sheet'
import type { Still, ValleyStill } from './Still'
import { streets, type StreetStill } from './streets'
import { terrains, type TerrainStill } from './terrains'
import { valleys } from './valleys'

/** A still of any kind. */
export type AnyStill = Still | ValleyStill | TerrainStill | StreetStill

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
  ...sheet,
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
    compensation: 0.8,
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
    inSpace: true,
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
