import { aureolePhase, cloudPhase, scalePhase, type CloudPhaseParameters } from './cloudPhase'
import { sampleSkylitSlab, sampleSunlitSlab } from './cloudLightTable'
import * as c from './lateralLeak'

/** Where a sample is in its cloud. All depths are scaled optical depths τ′ = `depthScale` τ. */
export interface CloudSourceSample {
  /** From the sample to the sun, ≥ 0. */
  depthToSun: number
  /** Of the whole cloud along the sun's axis through the sample, ≥ `depthToSun`. */
  depthThrough: number
  /** Of the cloud across the sun's axis: its diameter, for a ball. Of no effect on a layer. */
  depthAcross: number
  /** From the eye to the sample, in the cloud. */
  depthToEye: number
  /** 1 for a plane-parallel layer, 0 for a cloud that is as wide as it is deep. */
  layered: number
  /** The sun against the local up. */
  cosSun: number
  /** The direction that is looked in, against the local up. */
  cosView: number
  /** Between both. */
  cosViewSun: number
}

const clamp = (x: number, low: number, high: number): number => Math.min(Math.max(x, low), high)

/**
 * How much of a slab's multiply scattered light a ball keeps: what leaves through its sides is lost.
 *
 * @param diffusing - 1 − χ′₁.
 * @see lateralLeak.ts
 */
export function lateralLeak(
  { depthToSun, depthThrough, depthAcross }: CloudSourceSample,
  diffusing: number
): number {
  const part = clamp(depthToSun / Math.max(depthThrough, 1e-4), 0, 1)
  const depth = Math.log(1 + diffusing * Math.min(depthAcross, c.deepestPuff))
  const chord = clamp(depthThrough / Math.max(depthAcross, 1e-4), 0, 1)
  const exponent =
    c.constant +
    c.part * part +
    c.depth * depth +
    c.chord * chord +
    c.part2 * part ** 2 +
    c.depth2 * depth ** 2 +
    c.chord2 * chord ** 2 +
    c.partDepth * part * depth +
    c.partChord * part * chord +
    c.depthChord * depth * chord
  return Math.exp(exponent)
}

/**
 * Sunlight scattered into a direction, any number of times: radiance per scaled extinction for unit
 * irradiance of the sun [1/sr]. Float64 twin of the shader function.
 *
 * @param table - Of this phase function.
 */
export function cloudSource(
  phase: CloudPhaseParameters,
  table: Float32Array,
  sample: CloudSourceSample
): number {
  const { depthToSun, depthThrough, depthToEye, layered, cosViewSun } = sample
  const { depthScale, moments } = scalePhase(phase)
  const sign = sample.cosSun < 0 ? -1 : 1
  // The slab's normal: up (or down, under a low sun) for layers, towards the sun for lone clouds.
  const length = Math.hypot(
    layered * Math.sqrt(1 - sample.cosSun ** 2),
    layered * Math.abs(sample.cosSun) + 1 - layered
  )
  const cosSun = clamp((layered * sign * sample.cosSun + 1 - layered) / length, 0, 1)
  const cosView = (layered * sign * sample.cosView + (1 - layered) * cosViewSun) / length
  const thickness = depthThrough * cosSun
  const depth = clamp(depthToSun * cosSun, 0, thickness)
  const m = sampleSunlitSlab(table, depth, thickness, cosSun)
  const along = cosViewSun - cosView * cosSun
  const sines = (1 - cosView ** 2) * (1 - cosSun ** 2)
  const diffuse =
    m.s00 +
    m.s10 * cosView +
    (m.s20 * (3 * cosView ** 2 - 1)) / 2 +
    (m.s11 + m.s21 * cosView) * along +
    m.s22 * (2 * along ** 2 - sines)
  const leak = lateralLeak(sample, 1 - moments[1]) ** (1 - layered)
  const exact = cloudPhase(phase, cosViewSun)
  const towards = clamp(10 * cosViewSun - 9, 0, 1)
  const aureole = aureolePhase(phase, cosViewSun, depthToSun + depthToEye)
  const single = exact + (aureole - exact) * towards
  const scattered = (phase.scatteringAlbedo / depthScale) * single * Math.exp(-depthToSun)
  return Math.max(diffuse * leak, 0) + scattered
}

/**
 * A ball lets light in from its sides: it is lit by sky and ground like a slab of this part of its
 * thickness. That is within 0.035 of the sky's radiance (root mean square) of Monte-Carlo solutions of
 * balls of scaled optical diameters from 0.6 to 40.
 */
export const PUFF_DEPTH = 0.2

/** Where a sample is between sky and ground. Depths are scaled optical depths along the vertical. */
export interface CloudAmbientSample {
  /** From the sample to the cloud's top. */
  depthAbove: number
  /** From the sample to its base. */
  depthBelow: number
  /** 1 for a plane-parallel layer, 0 for a cloud that is as wide as it is deep. */
  layered: number
  /** The direction that is looked in, against the local up. */
  cosView: number
}

/**
 * Light of sky and ground scattered into a direction, any number of times: radiance per scaled
 * extinction, as the shares of the mean radiances of the hemispheres above and below [1]. Float64 twin
 * of the shader function.
 */
export function cloudAmbient(
  table: Float32Array,
  { depthAbove, depthBelow, layered, cosView }: CloudAmbientSample
): { sky: number; ground: number } {
  const openness = layered + (1 - layered) * PUFF_DEPTH
  const above = Math.max(depthAbove, 0) * openness
  const below = Math.max(depthBelow, 0) * openness
  const share = (depth: number, cos: number): number => {
    const [s00, s10, s20] = sampleSkylitSlab(table, depth, above + below)
    return Math.max(s00 + s10 * cos + (s20 * (3 * cos ** 2 - 1)) / 2, 0)
  }
  return { sky: share(above, cosView), ground: share(below, -cosView) }
}
