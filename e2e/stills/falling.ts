/** Rain and snow under clouds, seen from afar. */
export const falling = [
  {
    name: 'shower',
    about:
      'a storm aside: diffuse slanting curtains under its base with gaps between, dark before the bright sky, no box edges',
    clouds: {
      preset: 'shower',
      coverage: 0.2,
      layer: { baseAltitude: 1500, precipitation: { rate: 12 } }
    },
    place: { longitude: 140.6426, latitude: 35.2626 },
    altitude: 60,
    sun: { elevation: 30, azimuth: 180 },
    view: { azimuth: 90, pitch: 10 },
    fieldOfView: 62,
    land: 'hills'
  },
  {
    name: 'shower-bow',
    about:
      'a sun of 29° behind: both bows stand in the sunlit shaft, the outer one with its colours the other way round, dark between them',
    clouds: {
      preset: 'shower',
      coverage: 0.2,
      layer: { baseAltitude: 1500, precipitation: { rate: 8, streaks: 1 } }
    },
    place: { longitude: 140.6426, latitude: 35.2626 },
    altitude: 60,
    sun: { elevation: 29, azimuth: 270 },
    view: { azimuth: 90, pitch: 10 },
    fieldOfView: 62,
    land: 'hills'
  },
  {
    name: 'virga',
    about:
      'combed tails below altocumulus in a low sun, which curve away with the wind and end in the air, the strongest deepest',
    clouds: {
      preset: 'altocumulus',
      layer: {
        topAltitude: 4400,
        coverage: 0.12,
        density: 0.006,
        weatherScale: 0.6,
        shapeScale: 0.8,
        wind: { east: 9, north: -2 },
        precipitation: { rate: 4, share: 0.9, virgaDepth: 900, freezingLevel: 0, streaks: 2 }
      }
    },
    place: { longitude: 20.6, latitude: 45.6 },
    altitude: 60,
    sun: { elevation: 6, azimuth: 290 },
    view: { azimuth: 340, pitch: 16 },
    fieldOfView: 62,
    land: 'hills'
  },
  {
    name: 'snow-shower',
    about:
      'snow that trails far behind its clouds: towers bright in a low sun, bases dark, grey veils swept aside under them',
    clouds: {
      preset: 'snowShower',
      coverage: 0.1,
      layer: { precipitation: { rate: 1.5, freezingLevel: 0 } }
    },
    place: { longitude: 20, latitude: 45 },
    altitude: 60,
    sun: { elevation: 18, azimuth: 280 },
    view: { azimuth: 20, pitch: 9 },
    fieldOfView: 62,
    land: 'snow'
  },
  {
    name: 'nimbostratus',
    about:
      'steady rain that begins some kilometres ahead: grey bands from a closed deck to the hills, which fade one behind the other',
    clouds: {
      preset: 'nimbostratus',
      coverage: 0.92,
      layer: {
        baseAltitude: 1400,
        topAltitude: 4300,
        precipitation: { rate: 12, share: 0.3, streaks: 2 }
      }
    },
    place: { longitude: 22.3, latitude: 46.7 },
    altitude: 60,
    sun: { elevation: 35, azimuth: 280 },
    view: { azimuth: 30, pitch: 7 },
    fieldOfView: 45,
    land: 'hills'
  }
] as const
