/** Flashes of lightning by night. */
export const flashes = [
  {
    name: 'lightning-ground',
    about:
      'a flash to the ground at night: a forked channel, the cloud above glows from inside, the land is lit',
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 139.571, latitude: 35.995 },
    lightning: { kind: 'ground', azimuth: 1, distance: 17_500 },
    altitude: 200,
    sun: new Date('2026-06-14T14:00:00Z'),
    view: { azimuth: 0, pitch: 16 },
    land: 'hills'
  },
  {
    name: 'lightning-cloud',
    about: 'a flash in a storm, from the ground: soft light, no bright outlines',
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 139.853, latitude: 35.845 },
    lightning: { kind: 'cloud', azimuth: 20, distance: 17_000 },
    altitude: 60,
    sun: new Date('2026-06-14T14:00:00Z'),
    view: { azimuth: 20, pitch: 14 },
    compensation: -0.7,
    land: 'hills'
  },
  {
    name: 'lightning-10km',
    about: 'a tower lit from inside, from an airliner',
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 139.571, latitude: 35.995 },
    lightning: { kind: 'cloud', azimuth: -4, distance: 19_000 },
    altitude: 7000,
    sun: new Date('2026-06-14T14:00:00Z'),
    view: { azimuth: 0, pitch: -4 },
    compensation: -1,
    land: 'planet'
  },
  {
    name: 'lightning-between',
    about:
      'the same storm as from the ground, between flashes: a dark cloud before stars and airglow, not black',
    clouds: { preset: 'cumulonimbus' },
    place: { longitude: 139.571, latitude: 35.995 },
    altitude: 200,
    sun: new Date('2026-06-14T14:00:00Z'),
    view: { azimuth: 0, pitch: 16 },
    compensation: 1.3,
    land: 'hills'
  }
] as const
