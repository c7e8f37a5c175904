import { float } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { loop, type Float, type Int } from '../../tsl-types'

/** Growth of a march's steps over that of the scale height of molecules: larger puts more steps low. */
const STEP_GROWTH = 0.3

/**
 * κ of the steps of a path, see {@link march}; never 0, where they would be 0/0.
 *
 * @param rise - Altitude at the end of the path less that at its start [m].
 */
export function stepExponent({ homogeneousHeight }: AtmosphereUniforms, rise: Float): Float {
  const wanted = rise.div(homogeneousHeight).mul(STEP_GROWTH).clamp(-4, 4)
  return wanted.abs().max(0.05).mul(wanted.lessThan(0).select(-1, 1))
}

/**
 * Cuts a path into steps, t(x) = t_max (e^{κx} − 1)/(e^κ − 1): short where the air is dense, at the
 * lower end of the path.
 *
 * @param distance - Length of the path [m].
 * @param rise - Altitude at its end less that at its start [m].
 * @param step - Called with the distances at which a step starts and ends [m].
 */
export function march(
  uniforms: AtmosphereUniforms,
  distance: Float,
  rise: Float,
  steps: number | Int,
  step: (start: Float, end: Float) => void
): void {
  const exponent = stepExponent(uniforms, rise).toConst()
  const scale = distance.div(exponent.exp().sub(1)).toConst()
  const inverse = float(1)
    .div(float(steps as number))
    .toConst()
  const start = float(0).toVar()
  loop('step', steps, index => {
    const x = float(index).add(1).mul(inverse)
    const end = exponent.mul(x).exp().sub(1).mul(scale).toConst() as Float
    step(start, end)
    start.assign(end)
  })
}
