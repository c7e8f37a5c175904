/** Flashes of lightning by night. */
export const flashes = [
  {
    name: 'lightning-ground',
    about: 'a flash to the ground at night: a forked channel, the cloud above glows from inside',
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 142.4, latitude: 35.7 },
    lightning: { kind: 'ground', azimuth: 118, distance: 12_000 },
    altitude: 200,
    sun: new Date('2026-06-14T14:00:00Z'),
    view: { azimuth: 118, pitch: 16 },
    land: 'planet'
  },
  {
    name: 'lightning-cloud',
    about: 'a flash in a storm, from the ground: soft light, no bright outlines',
    clouds: { preset: 'cumulonimbus' },
    lightning: { kind: 'cloud', azimuth: 20, distance: 20_000 },
    altitude: 60,
    sun: new Date('2026-06-14T14:00:00Z'),
    view: { azimuth: 20, pitch: 14 },
    land: 'hills'
  },
  {
    name: 'lightning-10km',
    about: 'a tower lit from inside, from an airliner',
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 142.4, latitude: 35.7 },
    lightning: { kind: 'cloud', azimuth: 118, distance: 13_000 },
    altitude: 9000,
    sun: new Date('2026-06-14T14:00:00Z'),
    view: { azimuth: 115, pitch: -4 },
    land: 'planet'
  }
] as const
