import type { CloudPresetName } from '@welkin/clouds'
import type { Still } from './Still'

/**
 * Presets of the contact sheet in the clouds' docs, a row each: from the ground (`presets.ts`: aside, behind, low) and by these views. Taken at
 * 480×354, put together by ImageMagick:
 * `montage $rows -tile 6x8 -resize 240x177 -geometry +0+0 -quality 76 packages/clouds/docs/contact-sheet.jpg`.
 */
const presets: readonly CloudPresetName[] = [
  'fairWeather',
  'stratocumulus',
  'overcast',
  'congestus',
  'altocumulus',
  'cirrus',
  'mixed',
  'cumulonimbus'
]

/** Views of all of them from above; of storms, from the height of their tops. */
const views: Readonly<Record<string, Omit<Still, 'name' | 'clouds'>>> = {
  '3km': {
    about: 'from 3 km before sunset: lit edges, haze below',
    altitude: 3000,
    sun: { elevation: 8, azimuth: 60 },
    view: { azimuth: 20, pitch: -6 },
    shafts: true,
    land: 'hills'
  },
  '10km': {
    about: 'from an airliner',
    altitude: 10_000,
    sun: { elevation: 40, azimuth: 280 },
    view: { azimuth: 0, pitch: -8 },
    land: 'planet'
  },
  '400km': {
    about: 'from orbit, with the limb',
    altitude: 400_000,
    sun: { elevation: 45, azimuth: 100 },
    view: { azimuth: 60, pitch: -32 },
    land: 'planet'
  }
}

/** Place before a storm, and heights from which all of it is seen [m]. */
const STORM = { longitude: 139.571, latitude: 35.995 }
const STORM_HEIGHTS: Readonly<Record<string, number>> = { '3km': 3000, '10km': 7000 }

/** Still of a preset by a view. */
function stillOf(preset: CloudPresetName, name: string): Still {
  const still = { ...views[name], name: `sheet-${preset}-${name}`, clouds: { preset } }
  const altitude = STORM_HEIGHTS[name]
  if (preset !== 'cumulonimbus' || altitude === undefined) return still
  return { ...still, place: STORM, altitude, view: { azimuth: 0, pitch: -4 }, land: 'planet' }
}

export const sheet: Still[] = presets.flatMap(preset =>
  Object.keys(views).map(name => stillOf(preset, name))
)
