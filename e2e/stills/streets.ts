import type { StreetWeather } from '../../stories/src/street/Street'

/** A still of a street in rain or snow. */
export interface StreetStill {
  name: string
  /** Features to look for. */
  about: string
  street: StreetWeather
}

/** Rain and snow in a street. */
export const streets: StreetStill[] = [
  {
    name: 'rain-near',
    about: 'a wet street by day: streaks of all lengths, faint ones behind; none under roofs',
    street: { rain: 25, snow: 0, wind: 3, elevation: 25, shutter: 1 / 120 }
  },
  {
    name: 'rain-none',
    about: 'the same without rain: what it costs is the difference',
    street: { rain: 0, snow: 0, wind: 3, elevation: 25, shutter: 1 / 120 }
  },
  {
    name: 'snow-near',
    about:
      'snow in a street with lamps at night: cones of light, flakes of many sizes, soft near ones',
    street: { rain: 0, snow: 2.5, wind: 1, elevation: -25, shutter: 1 / 60 }
  },
  {
    name: 'snow-day',
    about:
      'snowfall by day: flakes of many sizes, dark before the sky and bright before walls; no rows',
    street: { rain: 0, snow: 2.5, wind: 1, elevation: 20, shutter: 1 / 120 }
  },
  {
    name: 'rain-night',
    about: 'rain under lamps at night: bright against the light',
    street: { rain: 12, snow: 0, wind: 2, elevation: -25, shutter: 1 / 60 }
  }
]
