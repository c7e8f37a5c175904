import { float, mix, mx_noise_float, smoothstep, vec3 } from 'three/tsl'
import type { Float, Vec3 } from '../../tsl-types'

/** Surface of the ground. */
export interface GroundSurface {
  /** Reflectance of land, linear sRGB. */
  color: Vec3
  /** Fraction of open water, in [0, 1]. */
  water: Float
}

const noise = mx_noise_float as unknown as (position: Vec3) => Float

/** Rotation between octaves, so that their lattices do not coincide. */
const rotateLattice = (p: Vec3): Vec3 =>
  vec3(p.dot(vec3(0, 0.8, 0.6)), p.dot(vec3(-0.8, 0.36, -0.48)), p.dot(vec3(-0.6, -0.48, 0.64)))

/** Fractal noise without octaves finer than a pixel. */
function bandLimitedNoise(position: Vec3, octaves: number, footprint: Float): Float {
  let sum: Float = float(0)
  let at = position
  for (let octave = 0; octave < octaves; octave++) {
    const frequency = 2.03 ** octave
    const visible = smoothstep(0.5, 1, footprint.mul(2 * frequency)).oneMinus()
    sum = sum.add(
      noise(at)
        .mul(visible)
        .mul(0.55 ** octave)
    )
    at = rotateLattice(at).mul(2.03).toConst()
  }
  return sum
}

/**
 * Procedural land, sea and ice.
 *
 * Colours and thresholds were found by looking: a higher sea level (0.06) drowns the continents, a larger
 * share of moisture (1.8) breaks up the belt of deserts. Story: Planets, MadeUp.
 *
 * @param normal - Unit length, z to the north pole.
 * @param footprint - Size of a pixel, in units of the radius.
 * @param seed - Another number gives other continents.
 */
export function proceduralGround(normal: Vec3, footprint: Float, seed: number): GroundSurface {
  const at = normal
    .mul(1.6)
    .add(vec3(seed * 7.31, seed * 3.17, seed * 5.73))
    .toConst() as Vec3
  const height = bandLimitedNoise(at, 9, footprint.mul(1.6)).sub(0.06).toConst()
  const shore = footprint.mul(0.7).add(0.008).toConst()
  const land = smoothstep(shore.negate(), shore, height).toConst()
  const moisture = bandLimitedNoise(at.mul(1.9).add(11.5), 4, footprint.mul(3)).toConst()
  const sine = normal.z.abs().toConst()
  // Wet tropics, dry belts about 25°, temperate, then cold.
  const belt = smoothstep(0.1, 0.35, sine).mul(smoothstep(0.45, 0.75, sine).oneMinus())
  const dry = belt.sub(moisture.mul(1.8)).clamp().toConst()
  const green = mix(vec3(0.022, 0.05, 0.014), vec3(0.06, 0.085, 0.035), smoothstep(0.2, 0.8, sine))
  const soil = mix(green, vec3(0.27, 0.19, 0.1), dry)
  const rock = mix(soil, vec3(0.2, 0.17, 0.14), smoothstep(0.25, 0.6, height).mul(0.7))
  const cold = sine.add(height.max(0).mul(0.25)).add(moisture.mul(0.07)).toConst()
  const ice = smoothstep(0.9, 0.94, cold.sub(land.oneMinus().mul(0.035))).toConst()
  return {
    color: mix(rock, vec3(0.72, 0.76, 0.8), ice).toConst(),
    water: land.oneMinus().mul(ice.oneMinus()).toConst()
  }
}
