import { FragmentPass } from '@welkin/atmosphere'
import { Fn, If, exp2, float, uv, vec3, vec4 } from 'three/tsl'
import { unpack } from '../temporal/tsl/packing'
import type { CloudTargets } from '../temporal/tsl/renderTargets'
import type { Float, Vec2 } from '../tsl-types'

/** Quantity shown instead of clouds, for debugging: white is most. */
export type CloudsDebug =
  /** Opacity of the clouds all along the line of sight. */
  | 'density'
  /** Steps of the last ray marched nearby, of 256. */
  | 'steps'
  /** Distance, by its logarithm: black at 100 m, white at 1000 km. */
  | 'depth'
  /** Accumulated samples of a pixel, of 32. */
  | 'history'

/** All debug views by their number; 0 is that of the clouds themselves. */
export const debugViews: readonly (CloudsDebug | null)[] = [
  null,
  'density',
  'steps',
  'depth',
  'history'
]

/**
 * Pass that draws a debug view as if it were clouds, of a gain of 1.
 *
 * @param debug - Its number.
 */
export function debugPass(
  debug: Float,
  accumulated: CloudTargets,
  marched: CloudTargets
): FragmentPass {
  const output = Fn(() => {
    const at = uv() as unknown as Vec2
    const { a: transmittance } = accumulated.light.sample(at).level(0).toConst()
    const distances = unpack(accumulated.distances.sample(at).level(0).toConst())
    const steps = marched.distances.sample(at).level(0).w
    const { x: distance, z: samples } = distances
    const values = [
      transmittance.oneMinus(),
      steps,
      exp2(distance).log().sub(Math.log(100)).div(Math.log(1e4)).clamp(),
      samples.abs().div(32)
    ]
    const shown = float(0).toVar()
    values.forEach((value, i) => {
      If(debug.equal(i + 1), () => {
        shown.assign(value)
      })
    })
    return vec4(vec3(shown), 0)
  })()
  return new FragmentPass('Welkin.CloudsDebug', output)
}
