import { float } from 'three/tsl'
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
  const { depthToLight, depthThrough, depthAcross, layered } = sample
  const { viewChord, verticalChord, filled, resolved = float(1) } = sample
  /** Share of the light that escapes along a chord, by the product of the depths to its ends. */
  const escape = (product: Float): Float =>
    product.max(0).sqrt().mul(light.oneMinusAsymmetry).mul(-fit.chordDepth).exp().toConst()
  const own = depthToLight.mul(depthThrough.sub(depthToLight)).toConst() as Float
  let openness: Float = float(0)
  if (viewChord) {
    const [front, behind] = viewChord
    // More than rays see is not known.
    const seen = front.mul(front.negate().add(fit.seenDepth).max(0)).toConst() as Float
    const open = escape(front.mul(behind).min(seen)).sub(escape(own.min(seen)))
    openness = openness.add(open.mul(fit.view))
  }
  if (verticalChord) {
    const open = escape(verticalChord[0].mul(verticalChord[1])).sub(escape(own))
    openness = openness.add(open.mul(fit.vertical))
  }
  const part = depthToLight.div(depthThrough.max(1e-4)).clamp().toConst()
  if (filled) {
    const [toLight, behind] = [depthToLight, depthThrough.sub(depthToLight)].map(length =>
      length.max(0).add(1).log().toConst()
    )
    const gaps = filled
      .clamp(fit.leastFilled, 1)
      .log()
      .mul(behind.div(2).add(toLight).sub(fit.gapsFrom))
      .mul(depthThrough.div(-fit.gapsDepth).exp())
    const round = part.mul(part).mul(toLight)
    openness = openness.sub(gaps.mul(fit.gaps)).sub(round.mul(fit.around))
  }
  const depth = light.oneMinusAsymmetry
    .mul(depthAcross.min(fit.largestDiameter))
    .add(1)
    .log()
    .toConst()
  const chord = depthThrough.div(depthAcross.max(1e-4)).clamp().toConst()
  const byPart = part.mul(fit.part2).add(depth.mul(fit.partDepth)).add(chord.mul(fit.partChord))
  const byDepth = depth.mul(fit.depth2).add(chord.mul(fit.depthChord)).add(fit.depth)
  return byPart
    .add(fit.part)
    .mul(part)
    .add(byDepth.mul(depth))
    .add(chord.mul(fit.chord2).add(fit.chord).mul(chord))
    .add(fit.constant)
    .sub(openness.mul(resolved))
    .mul(layered.oneMinus())
    .exp()
}
