/** Light shafts: hills and clouds cast into the air. */
export const shafts = [
  {
    name: 'shafts-deck',
    about:
      "a broken deck under a sun of 20°: Jacob's ladder below it, no bands, no halo at edges of clouds",
    clouds: { preset: 'stratocumulus', coverage: 0.6 },
    place: { longitude: 140.81, latitude: 35.68 },
    turbidity: 12,
    sun: { elevation: 20, azimuth: 30 },
    view: { azimuth: 34, pitch: 12 },
    altitude: 2,
    land: 'hills',
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
    name: 'shafts-opposite',
    about: 'rays that run together opposite a sunset',
    clouds: { preset: 'congestus', coverage: 0.4 },
    sun: { elevation: 3, azimuth: 250 },
    view: { azimuth: 70, pitch: 10 },
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
  },
  {
    name: 'shafts-storm',
    about: "a storm's shadow on its own anvil's haze and on the air below, from 10 km",
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 139.571, latitude: 35.995 },
    sun: { elevation: 9, azimuth: 20 },
    view: { azimuth: 0, pitch: -3 },
    altitude: 9000,
    land: 'planet',
    shafts: true
  },
  {
    name: 'shafts-ridge',
    about:
      'a ridge before a sun of 5°, over valley fog: its shadow in the fog, with one edge from the shoulder where the sun stands',
    fog: { density: 0.004, falloff: 70 },
    sun: { elevation: 5, azimuth: 150 },
    view: { azimuth: 164, pitch: -3 },
    altitude: 420,
    land: 'hills',
    shafts: true
  }
] as const
