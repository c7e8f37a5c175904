import { float } from 'three/tsl'
import type { Float } from '../../tsl-types'
import { headsFit as fit } from '../cpu/heads'
import type { LeakNodes } from './lateralLeak'

/** A sample as heads of its cloud have it. */
export interface HeadNodes {
  /** Depths as a slab would have them. */
  leak: LeakNodes
  /** Factor of light scattered more than once, by the cosine of the light on the cloud's face. */
  facing: Float
  /** Light from heads around: source function for unit irradiance above the cloud [1/sr]. */
  glow: Float
}

/**
 * Light among the heads of thick isolated clouds: shorter depths, the light's cosine on the face, and a glow. The face's
 * normal is the gradient of depth, known along two lines: it falls towards the light by 1 in the depth to the light, and towards
 * the camera by 1 in the depth to that. Nothing changes without a view chord. Twin: test/twins/heads.ts
 */
export function heads(sample: LeakNodes, cosViewLight: Float): HeadNodes {
  const { depthToLight, depthThrough, depthAcross, layered, viewChord, resolved } = sample
  if (viewChord === undefined) return { leak: sample, facing: float(1), glow: float(0) }
  const squared = depthThrough.mul(depthThrough).toConst()
  const square = squared.mul(squared).toConst()
  const weight = square
    .div(square.add(fit.thick ** 4))
    .mul(layered.oneMinus())
    .mul(resolved ?? 1)
    .toConst() as Float
  const shortened = (depth: Float, scale: number): Float => {
    const short = depth.div(scale).add(1).log().mul(scale).sub(depth)
    return short.mul(weight).add(depth).toConst()
  }
  const toLight = shortened(depthToLight, fit.toLight)
  const behind = shortened(depthThrough.sub(depthToLight).max(0).toConst() as Float, fit.behind)
  const through = toLight.add(behind).toConst()
  const [a, b] = [depthToLight, viewChord[0]].map(depth => depth.add(fit.least).reciprocal())
  const cosine = cosViewLight.negate().clamp(-fit.parallel, fit.parallel).toConst() as Float
  const gradient = a
    .mul(a)
    .add(b.mul(b))
    .sub(a.mul(b).mul(cosine).mul(2))
    .div(cosine.mul(cosine).oneMinus())
  const onFace = a.mul(gradient.max(a.mul(a)).inverseSqrt())
  return {
    leak: {
      ...sample,
      depthToLight: toLight,
      depthThrough: through,
      depthAcross: depthAcross.mul(through.div(depthThrough.max(1e-4))).toConst() as Float
    },
    facing: onFace.sub(0.5).mul(fit.cosine).mul(weight).exp(),
    glow: weight.mul(fit.glow)
  }
}
