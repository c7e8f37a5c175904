import { atan, mx_fractal_noise_float, vec4 } from 'three/tsl'
import type { Float, Vec2, Vec4 } from '../../tsl-types'
import { octahedralDirection } from '../../math/tsl/octahedron'

const DEGREE = Math.PI / 180

/**
 * Rotation from the frame of J2000 to galactic coordinates (X to the centre, Z to the north pole at
 * right ascension 192.859°, declination 27.128°; the north celestial pole at longitude 122.932°).
 *
 * @see The Hipparcos and Tycho Catalogues, ESA SP-1200 (1997), vol. 1, eq. 1.5.11
 */
export const CELESTIAL_TO_GALACTIC = [
  -0.0548755604, -0.8734370902, -0.4838350155, 0.4941094279, -0.44482963, 0.7469822445,
  -0.867666149, -0.1980763734, 0.4559837762
] as const

/**
 * Star clouds and the Magellanic Clouds: galactic longitude, latitude, half widths [°], strength.
 *
 * The strengths were found by looking: larger ones make blobs of the clouds that stand out of the band.
 * Story: Night, Wide.
 */
const STAR_CLOUDS = [
  ['Sagittarius', 6, -4, 7, 3.5, 1.5],
  ['Scutum', 27, -3, 4.5, 3, 1.3],
  ['Cygnus', 74, 1, 11, 4, 0.9],
  ['Norma', -32, -2, 8, 3, 0.9],
  ['Carina', -73, -1, 7, 2.5, 1.1],
  ['Large Magellanic Cloud', -79.5, -32.9, 3, 2.4, 1.4],
  ['Small Magellanic Cloud', -57.2, -44.3, 1.4, 1, 0.8]
] as const

/**
 * Dark clouds: galactic longitude, latitude, half widths [°], optical depth.
 *
 * The depths were found by looking: smaller ones fill in the Great Rift that splits the band. Story: Night,
 * Wide.
 */
const DARK_CLOUDS = [
  ['Coalsack', -57, -0.5, 3, 2.4, 1.5],
  ['Pipe and Ophiuchus', -1, 5, 9, 2.6, 1.8],
  ['Aquila rift', 28, 4.5, 17, 2.8, 2.2],
  ['Cygnus rift', 68, 1.5, 16, 1.8, 1.5],
  ['Northern Coalsack', 92, 2, 5, 2, 1]
] as const

/**
 * Optical depth of dust at 440, 520, 560, 630 nm over that at 550.
 *
 * @see Cardelli, Clayton & Mathis 1989, ApJ 345, 245, eqs. 1 and 3
 */
const REDDENING = vec4(1.3, 1.08, 0.98, 0.85)

/**
 * Unresolved starlight of the whole sky: a model with the photometric brightness of the poles, the band
 * and the galactic centre, and noise for clouds of stars and dust.
 *
 * @param point - Point of the octahedral map of directions in galactic axes, in [−1, 1]; a little beyond
 *   is across the edge.
 * @returns Luminance at the four wavelengths, reddened by dust, without the stars' colour [1e-4 cd/m²].
 * @see Leinert et al. 1998, "The 1997 reference of diffuse night sky brightness", §10
 */
export function milkyWayMap(point: Vec2): Vec4 {
  const direction = octahedralDirection(point)
  // Where y is −0 some implementations are half a turn off.
  const l = atan(direction.y.add(1e-7), direction.x).toConst()
  const longitude = l.div(DEGREE).toConst()
  const latitude = direction.z.clamp(-1, 1).asin().div(DEGREE).toConst()
  const noise = (scale: number, octaves: number): Float =>
    mx_fractal_noise_float(direction.mul(scale), octaves, 2.1, 0.55)
  const coarse = noise(7, 5).toConst()
  const fine = noise(21, 5).toConst()

  const gaussian = (cloud: readonly [string, number, number, number, number, number]): Float => {
    const [, longitude0, latitude0, width, height, strength] = cloud
    const across = longitude.sub(longitude0).div(width)
    const up = latitude.sub(latitude0).div(height)
    return across.mul(across).add(up.mul(up)).negate().exp().mul(strength)
  }
  const sum = (nodes: Float[]): Float => nodes.reduce((total, node) => total.add(node) as Float)

  const towards = l.cos().mul(0.5).add(0.5).pow(1.6)
  const wave = latitude.add(coarse.mul(2.5)).abs()
  const disc = wave.div(7.5).negate().exp().mul(towards.mul(2.4).add(1.3))
  const bulge = longitude
    .div(13)
    .pow2()
    .add(latitude.add(1.5).div(8).pow2())
    .negate()
    .exp()
    .mul(3.2)
  const clouds = sum(STAR_CLOUDS.map(gaussian)).mul(fine.mul(0.9).add(1).max(0.1))
  const grain = coarse.mul(0.7).add(fine.mul(0.5)).add(1).clamp(0.35, 2)
  const stars = disc.add(bulge).mul(grain).add(clouds)

  // Dust lies in a thinner sheet than the stars, and in a few near clouds outside it.
  const sheet = latitude.sub(0.6).div(2.2).pow2().negate().exp().mul(towards.mul(0.9).add(0.35))
  const dust = sum(DARK_CLOUDS.map(gaussian)).add(sheet)
  const clumps = fine.mul(1.6).add(coarse.mul(1.2)).add(0.75).clamp(0, 2.2)
  const depth = dust.mul(clumps)
  // Half of the stars are in front of the dust towards the anticentre, a fourth towards the centre.
  const front = towards.oneMinus().mul(0.25).add(0.12)
  const seen = vec4(REDDENING.mul(depth).negate().exp()).mul(front.oneMinus()).add(front)
  return vec4(seen.mul(stars).add(0.15).max(0))
}
