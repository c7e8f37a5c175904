import { float, vec4 } from 'three/tsl'
import { diffuseMoments } from '../../diffuseLight/tsl/diffuseLight'
import { applyMoments, momentBasis } from '../../diffuseLight/tsl/moments'
import type { Air } from '../../scattering/tsl/ray'
import { RAYLEIGH_MOMENT_2 } from '../../scattering/tsl/segment'
import { RADIANCE_SCALE } from '../../tables/tableSizes'
import { loop, type Float, type Int, type Vec4 } from '../../tsl-types'
import type { LitPoint } from './litRay'
import type { WarpedSteps } from './warpedSteps'

/** A view ray, as {@link lostDiffuse} goes along it. */
interface DiffuseRay {
  readonly steps: WarpedSteps
  readonly at: (inAir: Float) => LitPoint
  readonly cosViewLight: Float
  /** Number of samples. */
  readonly samples: Int
  /** Place of samples in their steps, in (0, 1). */
  readonly jitter: Float
  /** Part of the diffuse light at a distance, for a stretch of the steps, that is missing in the picture, by occluders; negative if there is more. */
  readonly missingAt: (inAir: Float, from: Float, width: Float) => Vec4
}

/**
 * Light scattered more than once that occluders keep from a view ray, for unit irradiance of the source [1/sr]:
 * the integral of the tables' diffuse light, of which a part is missing. Negative where clouds make it more.
 */
export function lostDiffuse(air: Air, ray: DiffuseRay): Vec4 {
  const { steps, at, cosViewLight, samples, jitter, missingAt } = ray
  const { uniforms } = air
  const lost = vec4(0).toVar()
  loop('diffuse', samples, index => {
    const position = jitter.add(index).div(samples).toConst() as Float
    const inAir = steps.distance(position).toConst() as Float
    const place = at(inAir)
    const moments = diffuseMoments(uniforms, air.diffuse!, place.altitude, place.cosLight)
    const basis = momentBasis(place.cosView, place.cosLight, cosViewLight)
    const light = place.seenRayleigh
      .mul(applyMoments(moments, basis, 0, RAYLEIGH_MOMENT_2))
      .add(
        place.seenMie.mul(applyMoments(moments, basis, uniforms.mieMoment1, uniforms.mieMoment2))
      )
    const width = float(1).div(samples).toConst() as Float
    const missing = missingAt(inAir, width.mul(float(index)), width)
    lost.addAssign(light.mul(missing).mul(steps.slope(position).mul(width)))
  })
  return lost.div(RADIANCE_SCALE)
}
