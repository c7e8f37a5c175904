import { float } from 'three/tsl'
import type { Float } from '../../tsl-types'
import { facingFit as fit } from '../cpu/facing'
import type { LeakNodes } from './lateralLeak'

/** A cloud about a sample, and its faces. */
export interface FacingNodes extends LeakNodes {
  /** Weight of its faces: 0 where footprints are too wide to tell them; left out, 1. */
  faces?: Float
}

/**
 * Factor of light scattered more than once in thick isolated clouds, by the cosine of the light on their faces. A face's normal is
 * the gradient of depth, whose parts along two lines are known: 1 over the depth to the light, and 1 over that to the camera.
 * 1 without a view chord. Twin: test/twins/cloudLight.ts
 */
export function facing(sample: FacingNodes, cosViewLight: Float): Float {
  const { depthToLight, depthThrough, layered, viewChord, faces = float(1) } = sample
  if (viewChord === undefined) return float(1)
  const squared = depthThrough.mul(depthThrough).toConst()
  const square = squared.mul(squared).toConst()
  const weight = square
    .div(square.add(fit.thick ** 4))
    .mul(layered.oneMinus())
    .mul(faces)
  const [a, b] = [depthToLight, viewChord[0]].map(depth =>
    depth.add(fit.least).reciprocal().toConst()
  )
  const cosine = cosViewLight.negate().clamp(-fit.parallel, fit.parallel).toConst() as Float
  const gradient = a
    .mul(a)
    .add(b.mul(b))
    .sub(a.mul(b).mul(cosine).mul(2))
    .div(cosine.mul(cosine).oneMinus())
  const onFace = a.mul(gradient.max(a.mul(a)).inverseSqrt())
  return onFace.sub(0.5).mul(fit.cosine).mul(weight).exp()
}
