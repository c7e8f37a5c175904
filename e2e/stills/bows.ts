import type { Still } from './Still'

/** Rain, with the sun behind. */
export const rainbows: Still[] = [
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
export const halos: Still[] = [
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
