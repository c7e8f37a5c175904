import { Fn, If, mix } from 'three/tsl'
import type { CloudLight } from '../CloudLightTable'
import { layout, type Float } from '../../tsl-types'

/** Least asymmetry of the broadened lobe: below it, terms cancel in float32 and none is left to see. */
export const LEAST_ASYMMETRY = 0.2

const FOUR_PI = 4 * Math.PI

/**
 * The Henyey–Greenstein phase function [1/sr]. Twin: cpu/cloudPhase.ts
 *
 * @param asymmetry - g, in (−1, 1).
 * @param cosScatter - Cosine of the scattering angle.
 */
export const henyeyGreenstein = /*#__PURE__*/ Fn(
  ([asymmetry, cosScatter]: [Float, Float]) => {
    const square = asymmetry.mul(asymmetry).toConst()
    // (1 − g)² + 2 g (1 − ν): 1 + g² − 2 g ν cancels in the peak.
    const squaredChord = asymmetry
      .oneMinus()
      .mul(asymmetry.oneMinus())
      .add(asymmetry.mul(2).mul(cosScatter.oneMinus()))
      .toConst()
    return square.oneMinus().div(squaredChord.mul(squaredChord.sqrt()).mul(FOUR_PI))
  },
  layout('cloudHenyeyGreenstein', 'float', { asymmetry: 'float', cosScatter: 'float' })
)

/** Terms l ≤ 2 of a Henyey–Greenstein function. */
const lowTerms = (asymmetry: Float, cosScatter: Float): Float => {
  const product = asymmetry.mul(cosScatter)
  const square = product.mul(product).mul(3).sub(asymmetry.mul(asymmetry))
  return product.mul(3).add(1).add(square.mul(2.5)).div(FOUR_PI)
}

/**
 * Phase function for light scattered once [1/sr], its peak broadened near the light by what it was
 * scattered within the peak on the way. Twins: cpu/cloudPhase.ts (`cloudPhase`, `aureolePhase`)
 *
 * @param cosScatter - Cosine of the scattering angle.
 * @param depth - Scaled depth from the light to the sample and on to the camera.
 */
export function singlePhase(light: CloudLight, cosScatter: Float, depth: Float): Float {
  const { forwardAsymmetry: g, backwardAsymmetry, forwardShare, scatteringScale } = light
  return Fn(() => {
    const lobe = henyeyGreenstein(g, cosScatter).toVar()
    If(cosScatter.greaterThan(0.9), () => {
      const mean = scatteringScale.mul(forwardShare).mul(g.mul(g).mul(g)).mul(depth).max(1e-3)
      const left = mean.negate().exp().oneMinus().div(mean).toConst()
      const h = g.pow(left.reciprocal()).max(LEAST_ASYMMETRY).toConst()
      const ratio = g.div(h).toConst()
      const peak = henyeyGreenstein(h, cosScatter).sub(lowTerms(h, cosScatter))
      const broad = lowTerms(g, cosScatter).add(left.mul(ratio.mul(ratio).mul(ratio)).mul(peak))
      lobe.assign(mix(lobe, broad, cosScatter.mul(10).sub(9).clamp()))
    })
    const back = henyeyGreenstein(backwardAsymmetry, cosScatter)
    return mix(back, lobe, forwardShare)
  })()
}
