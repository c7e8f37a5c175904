import { Vector4 } from 'three'
import { Fn, If, float, mix, smoothstep, vec2, vec3, vec4 } from 'three/tsl'
import {
  loop,
  vec4Array,
  type Float,
  type Vec2,
  type Vec3,
  type Vec4,
  type Vec4Array
} from '../../tsl-types'
import { cellRandom, fractalNoise } from '../../math/tsl/noise'
import { CRATERS, MARIA, RAYS, type MoonFeature } from './moonFeatures'

/** Angle from the middle of the near side to the edge of the map: as far as libration shows [rad]. */
const MAP_ANGLE = (102 * Math.PI) / 180

/** Half the width of the map, in units of the moon's radius. */
export const MAP_RADIUS = 2 * Math.sin(MAP_ANGLE / 2)

/**
 * Map coordinates of a point of the moon, by Lambert's azimuthal equal-area projection of the near side.
 *
 * @param direction - Moon's centre to the point, moon-fixed axes (X to the middle of the near side, Z
 *   north), unit length.
 * @see Snyder 1987, Map Projections: A Working Manual, §24
 */
export function moonMapUV(direction: Vec3): Vec2 {
  const scale = float(2).div(direction.x.add(1).max(1e-3)).sqrt().div(MAP_RADIUS)
  return vec2(direction.y, direction.z).mul(scale).mul(0.5).add(0.5)
}

/** Direction of a point of the map, moon-fixed axes: the inverse of {@link moonMapUV}. */
export function moonMapDirection(uv: Vec2): Vec3 {
  const point = uv.sub(0.5).mul(2 * MAP_RADIUS)
  const square = point.dot(point).min(3.999).toConst()
  const scale = square.div(4).oneMinus().sqrt()
  return vec3(square.div(2).oneMinus(), point.mul(scale)).normalize()
}

/** Features as texels (direction × strength, radius [rad]). */
function featureArray(features: readonly MoonFeature[]): Vec4Array {
  return vec4Array(
    features.map(([longitude, latitude, radius, strength]) => {
      const [east, north, size] = [longitude, latitude, radius].map(
        degrees => (degrees * Math.PI) / 180
      ) as [number, number, number]
      const level = Math.cos(north) * strength
      return new Vector4(
        level * Math.cos(east),
        level * Math.sin(east),
        strength * Math.sin(north),
        size
      )
    })
  )
}

interface Feature {
  centre: Vec3
  radius: Float
  strength: Float
}

/** Loops over features in the shader. */
function forEachFeature(
  name: string,
  features: readonly MoonFeature[],
  body: (feature: Feature) => void
): void {
  const array = featureArray(features)
  loop(name, features.length, index => {
    const feature = array.element(index).toConst()
    const strength = feature.xyz.length().toConst() as Float
    body({ centre: feature.xyz.div(strength).toConst(), radius: feature.w, strength })
  })
}

/** Fraction of the ground covered by maria, in [0, 1]. */
function mariaCoverage(direction: Vec3): Float {
  const ragged = fractalNoise(direction.mul(7), 6).mul(0.047)
  const warped = direction.add(ragged).normalize().toConst()
  const bare = float(1).toVar()
  forEachFeature('mare', MARIA, ({ centre, radius, strength }) => {
    const inside = radius.sub(warped.sub(centre).length())
    const cover = smoothstep(-0.045, 0, inside).mul(strength)
    bare.mulAssign(cover.oneMinus())
  })
  return bare.oneMinus().toConst()
}

/** Brightness of rays and haloes around young craters, in [0, 1]. */
function rayBrightness(direction: Vec3): Float {
  const bright = float(0).toVar()
  forEachFeature('ray', RAYS, ({ centre, radius, strength }) => {
    const away = direction.sub(centre).toConst()
    const distance = away.length().max(1e-4).toConst()
    If(distance.lessThan(radius.mul(1.15)), () => {
      const along = away.sub(centre.mul(away.dot(centre))).normalize()
      // Noise on a circle around the crater that changes slowly outwards: radial streaks.
      const at = along.mul(5).add(centre.mul(distance.mul(0.6).add(7)))
      const streak = smoothstep(-0.05, 0.6, fractalNoise(at, 3).x)
      const part = distance.div(radius).toConst()
      const halo = part.mul(part).mul(-40).exp().mul(0.8)
      const rays = streak.mul(part.mul(-2.2).exp()).mul(smoothstep(0.6, 1.15, part).oneMinus())
      bright.addAssign(halo.add(rays).mul(strength))
    })
  })
  return bright.min(1).toConst()
}

/**
 * Slope of a crater along the direction away from its centre: a flat floor, a wall up to the rim, and an
 * ejecta blanket outside.
 *
 * @param distance - Distance from the centre, over the crater's radius.
 */
function craterSlope(distance: Float): Float {
  const wall = smoothstep(0.35, 0.9, distance)
    .mul(smoothstep(0.95, 1.05, distance).oneMinus())
    .mul(0.9)
  const blanket = smoothstep(0.98, 1.08, distance).mul(distance.sub(1).mul(-3.5).exp()).mul(0.4)
  return wall.sub(blanket)
}

/** Octaves of random craters, each half the size of the one before. */
const CRATER_OCTAVES = 5
const NEIGHBOUR_CELLS = 8

/** Cratered ground: height gradient, tangent to the sphere, and brightness of fresh material in [0, 1]. */
function craterGradient(direction: Vec3, maria: Float): { gradient: Vec3; fresh: Float } {
  const gradient = vec3(0).toVar()
  const fresh = float(0).toVar()
  forEachFeature('crater', CRATERS, ({ centre, radius, strength }) => {
    const away = direction.sub(centre).toConst()
    const distance = away.length().max(1e-5).toConst() as Float
    const slope = craterSlope(distance.div(radius)).mul(strength)
    gradient.addAssign(away.div(distance).mul(slope))
  })
  loop('scale', CRATER_OCTAVES, scale => {
    const frequency = float(scale).exp2().mul(9).toConst()
    const scaled = direction.mul(frequency).toConst()
    loop('cell', NEIGHBOUR_CELLS, cell => {
      // The eight cells with the nearest centres.
      const index = float(cell).add(0.5)
      const offset = vec3(index, index.div(2), index.div(4)).floor().mod(2).sub(0.5)
      const corner = scaled.round().add(offset).toConst()
      const centre = corner.add(cellRandom(corner.sub(0.5)).sub(0.5).mul(0.8)).toConst()
      const height = centre.length().toConst()
      const away = direction.sub(centre.div(height)).toConst()
      const distance = away.length().max(1e-5).toConst() as Float
      // Cells with centres near the surface only, so that craters are evenly dense.
      const isNear = distance.mul(frequency).lessThan(0.6)
      If(isNear.and(height.sub(frequency).abs().lessThan(0.5)), () => {
        const random = cellRandom(corner.add(40.5)).toConst() as Vec3
        const exists = random.x.greaterThan(maria.mul(0.45).add(0.4)).select(1, 0).toConst()
        const radius = random.y.mul(random.y).mul(0.25).add(0.12).div(frequency)
        const part = distance.div(radius).toConst() as Float
        gradient.addAssign(away.div(distance).mul(craterSlope(part).mul(exists).mul(0.8)))
        const young = smoothstep(0.86, 1, random.z).mul(exists)
        fresh.addAssign(young.mul(part.mul(part).mul(-0.6).exp()))
      })
    })
  })
  const tangent = gradient.sub(direction.mul(gradient.dot(direction)))
  return { gradient: tangent.toConst(), fresh: fresh.min(1) }
}

/** Largest brightness that the map can hold, over the mean of the full disc. */
export const MAX_GROUND_BRIGHTNESS = 2

/** Mean brightness of the full disc before it is divided out; a GPU test of the moon holds it to 2 %. */
const DISC_MEAN = 0.979

/**
 * Ground of the moon: the maria, the large craters and their rays in their places, and many more random
 * craters.
 *
 * The brightnesses of highland and mare, 1.25 and 0.54, and the noise on them were found by looking:
 * closer together the face of the full moon fades, more noise makes it blotchy. Story: Moon, Full.
 *
 * @param direction - Moon's centre to the point, moon-fixed axes, unit length.
 * @returns Height gradient, tangent to the sphere, mapped from [−1, 1] to [0, 1]; and brightness at full
 *   moon over the mean of the disc, over {@link MAX_GROUND_BRIGHTNESS}.
 */
export const moonGround = (direction: Vec3): Vec4 =>
  Fn(() => {
    const maria = mariaCoverage(direction)
    const { gradient, fresh } = craterGradient(direction, maria)
    const rough = fractalNoise(direction.mul(7), 5).x
    const patches = fractalNoise(direction.mul(3.2).add(5), 4).y
    const highland = float(1.25).add(rough.mul(0.2))
    const sea = float(0.54).add(patches.mul(0.12)).add(rough.mul(0.06))
    const ground = mix(highland, sea, maria)
    const bright = ground.add(rayBrightness(direction).mul(0.6)).add(fresh.mul(0.12))
    return vec4(gradient.mul(0.5).add(0.5), bright.mul(1 / (DISC_MEAN * MAX_GROUND_BRIGHTNESS)))
  })()
