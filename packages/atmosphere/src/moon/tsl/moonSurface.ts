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

/** How far from the middle of the near side the map reaches [rad]: as far as libration shows. */
const MAP_REACH = (102 * Math.PI) / 180

/** Half the width of the map, a length of Lambert's azimuthal equal-area projection. */
export const MAP_RADIUS = 2 * Math.sin(MAP_REACH / 2)

/**
 * Where a place on the moon is on the map: Lambert's azimuthal equal-area projection of the near side.
 *
 * @param place - Moon-fixed, unit length: X to the middle of the near side, Z north.
 */
export function moonMapUV(place: Vec3): Vec2 {
  const scale = float(2).div(place.x.add(1).max(1e-3)).sqrt().div(MAP_RADIUS)
  return vec2(place.y, place.z).mul(scale).mul(0.5).add(0.5)
}

/** The inverse of {@link moonMapUV}. */
export function moonMapPlace(uv: Vec2): Vec3 {
  const point = uv.sub(0.5).mul(2 * MAP_RADIUS)
  const square = point.dot(point).min(3.999).toConst()
  const scale = square.div(4).oneMinus().sqrt()
  return vec3(square.div(2).oneMinus(), point.mul(scale)).normalize()
}

/** Features as (direction × strength, radius [rad]). */
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

/** Calls a function for each feature, in a shader's loop. */
function forEach(
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

/** How much of a place is covered by lava, in [0, 1]. */
function mariaCoverage(place: Vec3): Float {
  const ragged = fractalNoise(place.mul(7), 6).mul(0.047)
  const warped = place.add(ragged).normalize().toConst()
  const bare = float(1).toVar()
  forEach('mare', MARIA, ({ centre, radius, strength }) => {
    const inside = radius.sub(warped.sub(centre).length())
    const cover = smoothstep(-0.045, 0, inside).mul(strength)
    bare.mulAssign(cover.oneMinus())
  })
  return bare.oneMinus().toConst()
}

/** Brightness by rays and haloes of young craters, in [0, 1]. */
function rayBrightness(place: Vec3): Float {
  const bright = float(0).toVar()
  forEach('ray', RAYS, ({ centre, radius, strength }) => {
    const away = place.sub(centre).toConst()
    const distance = away.length().max(1e-4).toConst()
    If(distance.lessThan(radius.mul(1.15)), () => {
      const along = away.sub(centre.mul(away.dot(centre))).normalize()
      // Noise on a circle around the crater, that changes slowly on the way out.
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
 * Slope of a crater, along the direction away from its centre: a flat floor, walls, and outside of the
 * rim a blanket of what was thrown out.
 *
 * @param distance - From the centre, over the radius.
 */
function craterSlope(distance: Float): Float {
  const wall = smoothstep(0.35, 0.9, distance)
    .mul(smoothstep(0.95, 1.05, distance).oneMinus())
    .mul(0.9)
  const blanket = smoothstep(0.98, 1.08, distance).mul(distance.sub(1).mul(-3.5).exp()).mul(0.4)
  return wall.sub(blanket)
}

/** Sizes of craters by chance, each half of the one before. */
const SCALES = 5
const NEIGHBOURS = 8

/** Gradient of the height of ground strewn with craters of all sizes, tangent to the sphere. */
function craterGradient(place: Vec3, maria: Float): { gradient: Vec3; fresh: Float } {
  const gradient = vec3(0).toVar()
  const fresh = float(0).toVar()
  forEach('crater', CRATERS, ({ centre, radius, strength }) => {
    const away = place.sub(centre).toConst()
    const distance = away.length().max(1e-5).toConst() as Float
    const slope = craterSlope(distance.div(radius)).mul(strength)
    gradient.addAssign(away.div(distance).mul(slope))
  })
  loop('scale', SCALES, scale => {
    const frequency = float(scale).exp2().mul(9).toConst()
    const scaled = place.mul(frequency).toConst()
    loop('cell', NEIGHBOURS, cell => {
      // The eight cells whose middles are nearest.
      const index = float(cell).add(0.5)
      const offset = vec3(index, index.div(2), index.div(4)).floor().mod(2).sub(0.5)
      const corner = scaled.round().add(offset).toConst()
      const centre = corner.add(cellRandom(corner.sub(0.5)).sub(0.5).mul(0.8)).toConst()
      const height = centre.length().toConst()
      const away = place.sub(centre.div(height)).toConst()
      const distance = away.length().max(1e-5).toConst() as Float
      // Only cells whose centre is near the surface: as many craters everywhere.
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
  const tangent = gradient.sub(place.mul(gradient.dot(place)))
  return { gradient: tangent.toConst(), fresh: fresh.min(1) }
}

/** Brightest that the map holds, in units of the mean of the full disc. */
export const BRIGHTEST_GROUND = 2

/**
 * Makes the mean of the full disc 1.
 *
 * @see e2e/gpu/atmosphere/moon.gpu.ts, which holds it to 2 %.
 */
const MEAN = 0.979

/**
 * The ground of the moon: seas where they are, the large craters and their rays, and many more craters
 * by chance.
 *
 * @param place - Moon-fixed, unit length.
 * @returns Gradient of the height, tangent to the sphere, in [0, 1] for [−1, 1]; and the brightness of
 *   the full moon over the mean of its disc, over {@link BRIGHTEST_GROUND}.
 */
export const moonGround = (place: Vec3): Vec4 =>
  Fn(() => {
    const maria = mariaCoverage(place)
    const { gradient, fresh } = craterGradient(place, maria)
    const rough = fractalNoise(place.mul(7), 5).x
    const patches = fractalNoise(place.mul(3.2).add(5), 4).y
    const highland = float(1.25).add(rough.mul(0.2))
    const sea = float(0.54).add(patches.mul(0.12)).add(rough.mul(0.06))
    const ground = mix(highland, sea, maria)
    const bright = ground.add(rayBrightness(place).mul(0.6)).add(fresh.mul(0.12))
    return vec4(gradient.mul(0.5).add(0.5), bright.mul(1 / (MEAN * BRIGHTEST_GROUND)))
  })()
