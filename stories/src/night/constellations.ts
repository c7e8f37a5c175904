/** A star of a chart: name, right ascension [h], declination [°], J2000. */
type ChartStar = readonly [name: string, ascension: number, declination: number]

export interface Constellation {
  label: string
  /** Place and time at which it stands high: longitude and latitude [°], and the hour of 2026 in UTC. */
  place: { longitude: number; latitude: number }
  date: string
  stars: readonly ChartStar[]
  /** Pairs of stars, by index. */
  lines: readonly (readonly [number, number])[]
}

/** Five constellations as an atlas draws them; places from the Bright Star Catalogue, 5th edition. */
export const CONSTELLATIONS = {
  orion: {
    label: 'Orion',
    place: { longitude: 0, latitude: 45 },
    date: '2026-01-15T22:00:00Z',
    stars: [
      ['Betelgeuse', 5.9195, 7.407],
      ['Bellatrix', 5.4189, 6.35],
      ['Mintaka', 5.5334, -0.299],
      ['Alnilam', 5.6036, -1.202],
      ['Alnitak', 5.6793, -1.943],
      ['Saiph', 5.7959, -9.67],
      ['Rigel', 5.2423, -8.202],
      ['Meissa', 5.5856, 9.934]
    ],
    lines: [
      [0, 4],
      [4, 5],
      [5, 6],
      [6, 2],
      [2, 1],
      [1, 0],
      [2, 3],
      [3, 4],
      [0, 7],
      [7, 1]
    ]
  },
  ursaMajor: {
    label: 'Ursa Major (the Plough)',
    place: { longitude: 0, latitude: 45 },
    date: '2026-04-15T22:00:00Z',
    stars: [
      ['Dubhe', 11.0621, 61.751],
      ['Merak', 11.0307, 56.382],
      ['Phecda', 11.8972, 53.695],
      ['Megrez', 12.2571, 57.033],
      ['Alioth', 12.9005, 55.96],
      ['Mizar', 13.3988, 54.925],
      ['Alkaid', 13.7923, 49.313]
    ],
    lines: [
      [0, 1],
      [1, 2],
      [2, 3],
      [3, 0],
      [3, 4],
      [4, 5],
      [5, 6]
    ]
  },
  cassiopeia: {
    label: 'Cassiopeia',
    place: { longitude: 0, latitude: 45 },
    date: '2026-11-10T20:00:00Z',
    stars: [
      ['Caph', 0.1529, 59.15],
      ['Schedar', 0.6751, 56.537],
      ['Gamma', 0.9451, 60.717],
      ['Ruchbah', 1.4303, 60.235],
      ['Segin', 1.9066, 63.67]
    ],
    lines: [
      [0, 1],
      [1, 2],
      [2, 3],
      [3, 4]
    ]
  },
  scorpius: {
    label: 'Scorpius',
    place: { longitude: 0, latitude: -25 },
    date: '2026-06-14T23:00:00Z',
    stars: [
      ['Acrab', 16.0906, -19.805],
      ['Dschubba', 16.0056, -22.622],
      ['Fang', 15.9809, -26.114],
      ['Alniyat', 16.3531, -25.593],
      ['Antares', 16.4901, -26.432],
      ['Paikauhale', 16.5981, -28.216],
      ['Larawag', 16.8361, -34.293],
      ['Mu', 16.8645, -38.047],
      ['Zeta', 16.9098, -42.361],
      ['Eta', 17.2025, -43.239],
      ['Sargas', 17.622, -42.998],
      ['Iota', 17.7931, -40.127],
      ['Kappa', 17.7081, -39.03],
      ['Shaula', 17.5601, -37.104]
    ],
    lines: [
      [0, 1],
      [1, 2],
      [1, 3],
      [3, 4],
      [4, 5],
      [5, 6],
      [6, 7],
      [7, 8],
      [8, 9],
      [9, 10],
      [10, 11],
      [11, 12],
      [12, 13]
    ]
  },
  crux: {
    label: 'Crux',
    place: { longitude: 0, latitude: -35 },
    date: '2026-05-10T22:00:00Z',
    stars: [
      ['Acrux', 12.4433, -63.099],
      ['Gacrux', 12.5194, -57.113],
      ['Mimosa', 12.7953, -59.689],
      ['Imai', 12.2524, -58.749]
    ],
    lines: [
      [0, 1],
      [2, 3]
    ]
  }
} as const satisfies Record<string, Constellation>

export type ConstellationName = keyof typeof CONSTELLATIONS
