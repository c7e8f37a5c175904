/** A still of the procedural planet of `@welkin/terrain`. */
export interface TerrainStill {
  name: string
  /** Features to look for. */
  about: string
  terrain: {
    /** Place of the camera [°], and height above the ground [m]. */
    longitude: number
    latitude: number
    height: number
    /** Azimuth, clockwise from north, and pitch of the camera [°]. */
    heading: number
    pitch: number
    /** Elevation and azimuth of the sun, clockwise from north [°]. */
    sun: { elevation: number; azimuth: number }
    /** True to pave the grass with a user's maps. */
    cobbles?: boolean
    /** True for grass, flowers and trees of the stories' sample. */
    plants?: boolean
  }
}

/** The procedural planet: at one's feet, among its mountains, and from far above. */
export const terrains: TerrainStill[] = (
  [
    ['grass', 'a meadow: blades and tufts, no repetition', [0.494, 46.35, 1.7], [338, -8]],
    ['feet', "the same meadow before one's feet: detail to 1 cm", [0.494, 46.35, 1.7], [338, -50]],
    ['cobbles', 'maps of a user in place of grass, with depth', [0.494, 46.35, 1.7], [338, -35]],
    [
      'meadow',
      'the same with the sample of vegetation: blades, flowers',
      [0.494, 46.35, 1.7],
      [338, -8]
    ],
    [
      'woods',
      'an edge of woods: trees, and their pictures far away',
      [0.494, 46.35, 12],
      [338, -8]
    ],
    ['scree', 'stones between meadow and rock', [0.508, 46.65, 1.7], [275, -12]],
    ['snow', 'snow and rock about a summit', [0.428, 47.372, 1.7], [200, -8]],
    ['shore', 'sand, wet where the sea begins', [1.6848, 46.15, 1.7], [45, -8]],
    ['lake', 'a lake in a basin: shore, sky in it, waves', [0.5118, 46.563, 25], [10, -4]],
    ['1km', 'slopes, valleys and cliffs in low sun', [0.494, 46.35, 2e3], [338, -12]],
    ['10km', 'ranges without shimmer or grid', [0.45, 46.9, 1e4], [0, -12]],
    ['400km', 'a mountainous coast from orbit: woods, steppe, no net', [1, 44.5, 4e5], [0, -25]],
    ['down', 'the same coast, seen more from above', [0.5, 45.5, 4e5], [20, -60]],
    ['glint', 'the sun in the sea from orbit: wide, with calm patches', [1, 44.5, 4e5], [315, -30]]
  ] as const
).map(([name, about, [longitude, latitude, height], [heading, pitch]]) => ({
  name: `terrain-${name}`,
  about,
  terrain: {
    longitude,
    latitude,
    height,
    heading,
    pitch,
    sun: { elevation: 28, azimuth: heading + (name === 'glint' ? 10 : 100) },
    cobbles: name === 'cobbles',
    plants: name === 'meadow' || name === 'woods'
  }
}))
