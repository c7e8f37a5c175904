import { float } from 'three/tsl'
import type { Float } from '../../tsl-types'
import type { CloudLight } from '../CloudLightTable'
import { flowFit as fit } from '../cpu/flow'
import type { LeakNodes } from './lateralLeak'

/**
 * Flow of light scattered more than once in an isolated cloud, over a slab's: what it adds to the source towards the viewpoint, over the
 * source's mean. A place's distance from the axis towards the light is seen along the view ray, from the middle of whose chord it is away.
 * Twin: test/twins/cloudLight.ts
 *
 * @param cosView - The view ray against the slab's normal.
 */
export function flow(
  light: CloudLight,
  sample: LeakNodes,
  cosView: Float,
  cosViewLight: Float
): Float {
  const { depthToLight, depthThrough, depthAcross, viewChord, resolved = float(1) } = sample
  const depth = light.oneMinusAsymmetry.mul(depthAcross).toConst()
  const asymmetry = light.oneMinusAsymmetry.oneMinus()
  const term = ([size, scale]: readonly [number, number]): Float =>
    depth.div(scale).add(1).reciprocal().mul(size)
  const along = asymmetry.mul(asymmetry).mul(term(fit.along)).mul(cosView)
  const square = light.secondMoment
    .mul(term(fit.square))
    .mul(cosView.mul(cosView).mul(1.5).sub(0.5))
  const both = along.add(square)
  if (viewChord === undefined) return both
  // Beyond a sphere's end, by intersecting chords, another bulge begins.
  const [front, behind] = viewChord
  const own = depthToLight.mul(depthThrough.sub(depthToLight)).max(0)
  const onRay = behind.min(own.div(front.max(1e-4))).sub(front)
  const onAxis = depthThrough.sub(depthToLight.mul(2)).mul(cosViewLight)
  const aside = onRay.add(onAxis).div(depthAcross.max(1e-4)).clamp(-1, 1)
  const outwards = asymmetry.mul(3).mul(term(fit.aside))
  return both.add(outwards.mul(aside).mul(resolved))
}
