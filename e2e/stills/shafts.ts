import { shaftViews, type ShaftView } from '../../stories/src/shafts/views'

/** A still of a view of the story *Light shafts*. */
const stillOf = ([name, shaftView]: readonly [string, ShaftView]) => {
  const { label: _label, light, isMoonlit, ...rest } = shaftView
  const sun = isMoonlit ? { elevation: -40, azimuth: (light.azimuth + 180) % 360 } : { ...light }
  return { name: `shafts-${name}`, ...rest, sun, moon: isMoonlit && light, shafts: true as const }
}

/** Light shafts: hills, towers and clouds cast into the air. */
export const shafts = [
  ...Object.entries(shaftViews).map(stillOf),
  ...([
    {
      name: 'shafts-orbit',
      about:
        'from 300 km, the sun 4° up at the left: dark streaks behind storms, in the haze over the sea',
      clouds: { preset: 'cumulonimbus' },
      place: { longitude: 139.571, latitude: 35.995 },
      sun: { elevation: 4, azimuth: 290 },
      view: { azimuth: 0, pitch: -50 },
      altitude: 300_000,
      land: 'planet',
      shafts: true
    },
    {
      name: 'shafts-cumulus',
      about: 'the sun low behind cumulus: rays that fan out from gaps, dark behind towers',
      clouds: { preset: 'congestus' },
      sun: { elevation: 9, azimuth: 330 },
      view: { azimuth: 330, pitch: 10 },
      altitude: 2,
      land: 'hills',
      shafts: true
    },
    {
      name: 'shafts-overcast',
      about: 'haze under a closed deck as dark as the hills in it; compare overcast-aside',
      clouds: { preset: 'overcast' },
      sun: { elevation: 42, azimuth: 310 },
      view: { azimuth: 30, pitch: 4 },
      altitude: 300,
      land: 'hills',
      shafts: true
    }
  ] as const)
]
