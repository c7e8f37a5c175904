import { float, vec3, vec4 } from 'three/tsl'
import type { CloudLight } from '../CloudLightTable'
import { lateralLeakFit as fit } from '../cpu/lateralLeak'
import type { Float } from '../../tsl-types'

/** Extent of a cloud about a sample. All depths are scaled optical depths. */
export interface LeakNodes {
  /** Depth from the sample to the light, ≥ 0. */
  depthToLight: Float
  /** Through the whole cloud along the ray of light through the sample, ≥ `depthToLight`. */
  depthThrough: Float
  /** Across that ray: the diameter of a sphere. Of no effect on a deck. */
  depthAcross: Float
  /** 1 for a cloud deck (plane-parallel), 0 for an isolated cloud, as wide as it is deep. */
  layered: Float
  /** Chord of the cloud on the view ray, to the camera and behind; left out, a sphere's. */
  viewChord?: Chord
  /** Its chord along the vertical; left out, a sphere's. */
  verticalChord?: Chord
  /** Mean extinction on the ray of light, from end to end of its clouds, over that of dense cloud; left out, a sphere's. */
  filled?: Float
  /** Weight of these: 0 where clouds are not resolved, whose mean extinction knows no sides; left out, 1. */
  resolved?: Float
}

/** Depths from the sample to both ends of a straight line through its cloud. */
export type Chord = readonly [Float, Float]

/**
 * Lateral leak: share of a slab's multiply scattered light that an isolated cloud keeps: a sphere's, less where the
 * cloud is open along other lines than the light's. The product of the depths to both ends of a chord is
 * the same for all chords through a place of a sphere (intersecting chords theorem): chords with less leak more. Light of lobes that shade
 * others over a gap spreads in it, and comes round to shaded ends. Twin: test/twins/cloudLight.ts
 */
export function lateralLeak(light: CloudLight, sample: LeakNodes): Float {
  const { depthToLight, depthThrough, depthAcross, layered, filled, resolved = float(1) } = sample
  const own: Chord = [depthToLight, depthThrough.sub(depthToLight).max(0).toConst()]
  const { viewChord: [front, behind] = own, verticalChord: [above, below] = own } = sample
  const product = depthToLight.mul(own[1]).toConst()
  // More than rays see is not known.
  const seen = front.mul(front.negate().add(fit.seenDepth).max(0)).toConst()
  const products = vec4(front.mul(behind).min(seen), product.min(seen), above.mul(below), product)
  /** Shares of the light that escape along chords. */
  const escaped = products.max(0).sqrt().mul(light.oneMinusAsymmetry).mul(-fit.chordDepth).exp()
  let openness = escaped.dot(vec4(fit.view, -fit.view, fit.vertical, -fit.vertical))
  const part = depthToLight.div(depthThrough.max(1e-4)).clamp().toConst()
  if (filled) {
    const { weight, from, depth, least } = fit.gaps
    const [toLight, beyond] = own.map(each => each.add(1).log().toConst())
    const crossed = beyond.div(2).add(toLight).sub(from).mul(weight)
    const gaps = filled.clamp(least, 1).log().mul(crossed).mul(depthThrough.div(-depth).exp())
    openness = openness.sub(gaps).sub(part.mul(part).mul(toLight).mul(fit.around))
  }
  const depth = light.oneMinusAsymmetry.mul(depthAcross.min(fit.largestDiameter)).add(1).log()
  const chord = depthThrough.div(depthAcross.max(1e-4)).clamp()
  const at = vec3(part, depth, chord).toConst()
  return at
    .mul(vec3(...fit.squares))
    .add(vec3(...fit.linear))
    .add(at.yzx.mul(vec3(...fit.products)))
    .dot(at)
    .add(fit.constant)
    .sub(openness.mul(resolved))
    .mul(layered.oneMinus())
    .exp()
}
