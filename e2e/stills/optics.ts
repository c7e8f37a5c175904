/** Bows and rings of droplets. */
export const optics = [
  {
    name: 'optics-glory',
    about:
      'from an aeroplane over a bright deck, the sun behind: its shadow, and about it coloured rings of 1 to 4°, red outside',
    clouds: {
      preset: 'overcast',
      layer: { density: 0.006, shapeAmount: 0.25, edgeSoftness: 0.6, baseRelief: 0 }
    },
    shafts: true,
    aeroplane: true,
    dropletRadius: 10,
    altitude: 2600,
    sun: { elevation: 38, azimuth: 210 },
    view: { azimuth: 30, pitch: -38 },
    fieldOfView: 20,
    compensation: 0.8,
    place: { longitude: 150, latitude: 30 },
    land: 'planet'
  },
  {
    name: 'optics-cloudbow',
    about:
      'the same deck with a wide lens: the glory in the middle, about it a pale bow of 40°, on all sides',
    clouds: {
      preset: 'overcast',
      layer: { density: 0.004, shapeAmount: 0.25, edgeSoftness: 0.6, baseRelief: 0 }
    },
    dropletRadius: 12,
    altitude: 2600,
    sun: { elevation: 45, azimuth: 210 },
    view: { azimuth: 30, pitch: -45 },
    fieldOfView: 90,
    place: { longitude: 150, latitude: 30 },
    land: 'planet'
  },
  {
    name: 'optics-fogbow',
    about:
      'a broad white bow, 38° from the point opposite the sun, outside a little red, in mist on hills',
    fog: { density: 0.004, falloff: 60, dropletRadius: 9 },
    altitude: 12,
    sun: { elevation: 18, azimuth: 180 },
    view: { azimuth: 0, pitch: 8 },
    land: 'hills'
  },
  {
    name: 'optics-corona',
    about:
      'the sun behind a thin even cloud: an aureole of 3°, white and then brown at its edge, coloured rings around',
    clouds: {
      preset: 'altocumulus',
      coverage: 1,
      layer: { density: 0.0012, shapeAmount: 0.2, edgeSoftness: 0.8 }
    },
    dropletRadius: 6,
    altitude: 2,
    sun: { elevation: 28, azimuth: 30 },
    view: { azimuth: 30, pitch: 28 },
    fieldOfView: 24,
    compensation: -1.5,
    land: 'hills'
  }
] as const
