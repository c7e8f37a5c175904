import { luminance, mix, step, vec3 } from 'three/tsl'
import type { Float, Vec3 } from '../../tsl-types'

/** Greatest number that the targets keep: half floats hold a little more. */
export const MAX_KEPT = 6e4

/** Least light that other light is compared with [1/sr]. */
export const MIN_LIGHT = 1e-12

/** Part of the luminance below which a colour is not compared by itself: corona and dusk have colours near and below nought. */
const PALE = 0.2

/** Light of a ray. */
export interface LostLight {
  /** Light that it loses, linear sRGB of about that for unit irradiance. */
  readonly lost: Vec3
  /** Light of its air if nothing cast shadows, likewise. */
  readonly lit: Vec3
  /** log₂ of the distance to what is seen [octaves of a metre]. */
  readonly octaves: Float
}

/** Parts of the light that are lost, by colours. */
export function partsOf({ lost, lit }: LostLight): Vec3 {
  const all = luminance(lit).max(MIN_LIGHT).toConst()
  const isBright = vec3(step(all.mul(PALE), lit)).toConst()
  const [taken, whole] = [mix(vec3(luminance(lost)), lost, isBright), mix(vec3(all), lit, isBright)]
  return taken.div(whole).clamp(-MAX_KEPT, MAX_KEPT)
}
