import { eddingtonDiffuse } from '../../src/environment/cpu/decks'
import { scalePhase, type CloudPhaseParameters } from '../../src/light/cpu/cloudPhase'
import { facingFit } from '../../src/light/cpu/facing'
import { flowFit } from '../../src/light/cpu/flow'
import { lateralLeakFit as fit } from '../../src/light/cpu/lateralLeak'
import { skyShareFit } from '../../src/light/cpu/skyShare'
import { ISOLATED_DEPTH } from '../../src/light/tsl/cloudLight'
import { sampleBeamSource, sampleSkySource } from './cloudLightTable'
import { aureolePhase, cloudPhase } from './cloudPhase'

/** Depths about a sample in its cloud. All depths are scaled optical depths τ′ = `depthScale` τ. */
export interface CloudSourceSample {
  /** Depth from the sample to the light, ≥ 0. */
  depthToLight: number
  /** Through the whole cloud along the ray of light through the sample, ≥ `depthToLight`. */
  depthThrough: number
  /** Across that ray: the diameter of a sphere. Of no effect on a deck. */
  depthAcross: number
  /** Depth from the viewpoint to the sample, in the cloud. */
  depthToCamera: number
  /** Depths to both ends of the cloud on the view ray and along the vertical; left out, a sphere's. */
  viewChord?: readonly [number, number]
  verticalChord?: readonly [number, number]
  /** Part of the ray of light that is filled with cloud; left out, a sphere's. */
  filled?: number
  resolved?: number
  /** 1 for a cloud deck (plane-parallel), 0 for an isolated cloud, as wide as it is deep. */
  layered: number
  /** The light against the local up. */
  cosLight: number
  /** The view ray against the local up. */
  cosView: number
  /** Between both. */
  cosViewLight: number
}

const clamp = (x: number, low: number, high: number): number => Math.min(Math.max(x, low), high)

/**
 * Lateral leak: share of a slab's multiply scattered light that a sphere keeps; the rest leaves through its
 * sides. Twin of the shader function; coefficients in light/cpu/lateralLeak.ts.
 *
 * @param oneMinusAsymmetry - 1 − g′, with g′ = χ′₁ the asymmetry of the delta-scaled phase function.
 */
export function lateralLeak(sample: CloudSourceSample, oneMinusAsymmetry: number): number {
  const { depthToLight, depthThrough, depthAcross, viewChord, verticalChord, resolved = 1 } = sample
  const { filled } = sample
  const part = clamp(depthToLight / Math.max(depthThrough, 1e-4), 0, 1)
  const depth = Math.log(1 + oneMinusAsymmetry * Math.min(depthAcross, fit.largestDiameter))
  const chord = clamp(depthThrough / Math.max(depthAcross, 1e-4), 0, 1)
  const at = [part, depth, chord]
  const exponent = at.reduce(
    (sum, x, i) =>
      sum + fit.linear[i] * x + fit.squares[i] * x ** 2 + fit.products[i] * x * at[(i + 1) % 3],
    fit.constant
  )
  /** Share that escapes along a chord, by the geometric mean of the depths to its ends, in transport depths. */
  const escape = (mean: number): number => Math.exp(-fit.chordDepth * oneMinusAsymmetry * mean)
  const own = Math.sqrt(depthToLight * Math.max(depthThrough - depthToLight, 0))
  let openness = 0
  if (viewChord) {
    const [front, behind] = viewChord
    const seen = Math.sqrt(front * Math.max(fit.seenDepth - front, 0))
    const found = Math.min(Math.sqrt(front * behind), seen)
    openness += fit.view * (escape(found) - escape(Math.min(own, seen)))
  }
  if (verticalChord) {
    const [above, below] = verticalChord
    openness += fit.vertical * (escape(Math.sqrt(above * below)) - escape(own))
  }
  if (filled !== undefined) {
    const toLight = 1 + depthToLight
    const behind = 1 + Math.max(depthThrough - depthToLight, 0)
    const { weight, from, depth: deepest, least } = fit.gaps
    const gaps = Math.log(clamp(filled, least, 1)) * weight * Math.exp(-depthThrough / deepest)
    openness -= gaps * (Math.log(toLight * Math.sqrt(behind)) - from)
    openness -= fit.around * Math.log(toLight) * part ** 2
  }
  return Math.exp(exponent - openness * resolved)
}

/**
 * Flow of light in an isolated cloud over a slab's, over the source's mean, in float64. Twin of the shader function.
 *
 * @param moments - Legendre coefficients of the delta-scaled phase function.
 * @param cosView - The view ray against the slab's normal.
 */
export function flow(
  sample: CloudSourceSample,
  [, chi1, chi2]: readonly number[],
  cosView: number
): number {
  const { depthToLight, depthThrough, depthAcross, viewChord, cosViewLight, resolved = 1 } = sample
  const diameter = (1 - chi1) * depthAcross
  const along = (flowFit.along[0] * chi1 ** 2) / (1 + diameter / flowFit.along[1])
  const square = (flowFit.square[0] * chi2) / (1 + diameter / flowFit.square[1])
  const both = along * cosView + (square * (3 * cosView ** 2 - 1)) / 2
  if (viewChord === undefined) return both
  // From the middle of both chords, towards the camera and towards the light.
  const [front, seen] = viewChord
  const behind = Math.min(
    seen,
    (depthToLight * (depthThrough - depthToLight)) / Math.max(front, 1e-4)
  )
  const [towardsCamera, towardsLight] = [(behind - front) / 2, depthThrough / 2 - depthToLight]
  const radius = Math.max(depthAcross, 1e-4) / 2
  const aside = clamp((towardsCamera + cosViewLight * towardsLight) / radius, -1, 1)
  return (
    both + ((3 * chi1 * flowFit.aside[0]) / (1 + diameter / flowFit.aside[1])) * aside * resolved
  )
}

/** Factor of light by its cosine on the faces of thick isolated clouds, in float64. Twin of the shader function. */
function facing(sample: CloudSourceSample): number {
  const { depthToLight, depthThrough, layered, viewChord, cosViewLight } = sample
  if (viewChord === undefined) return 1
  const weight = (depthThrough ** 4 / (depthThrough ** 4 + facingFit.thick ** 4)) * (1 - layered)
  const a = 1 / (depthToLight + facingFit.least)
  const b = 1 / (viewChord[0] + facingFit.least)
  const cosine = Math.min(Math.max(-cosViewLight, -facingFit.parallel), facingFit.parallel)
  const gradient = (a * a + b * b - 2 * a * b * cosine) / (1 - cosine ** 2)
  const onFace = a / Math.sqrt(Math.max(gradient, a * a))
  return Math.exp(weight * facingFit.cosine * (onFace - 0.5))
}

/**
 * Source function of sun- or moonlight along a view ray, all orders of scattering: radiance per scaled
 * extinction for unit irradiance above the cloud [1/sr]. Float64 twin of the shader function.
 *
 * @param table - Light table of this phase function.
 */
export function cloudSource(
  phase: CloudPhaseParameters,
  table: Float32Array,
  sample: CloudSourceSample
): number {
  const { depthToLight, depthThrough, depthToCamera, layered, cosViewLight } = sample
  const { depthScale, moments } = scalePhase(phase)
  const sign = sample.cosLight < 0 ? -1 : 1
  // The slab's normal: up (or down, under a light below the horizon) for decks, towards the light for isolated clouds.
  const length = Math.hypot(
    layered * Math.sqrt(1 - sample.cosLight ** 2),
    layered * Math.abs(sample.cosLight) + 1 - layered
  )
  const cosLight = clamp((layered * sign * sample.cosLight + 1 - layered) / length, 0, 1)
  const cosView = (layered * sign * sample.cosView + (1 - layered) * cosViewLight) / length
  const thickness = depthThrough * cosLight
  const depth = clamp(depthToLight * cosLight, 0, thickness)
  const m = sampleBeamSource(table, depth, thickness, cosLight)
  const along = cosViewLight - cosView * cosLight
  const sines = (1 - cosView ** 2) * (1 - cosLight ** 2)
  const diffuse =
    m.s00 +
    m.s10 * cosView +
    (m.s20 * (3 * cosView ** 2 - 1)) / 2 +
    (m.s11 + m.s21 * cosView) * along +
    m.s22 * (2 * along ** 2 - sines) +
    m.s00 * (1 - layered) * flow(sample, moments, cosView)
  const leak = lateralLeak(sample, 1 - moments[1]) ** (1 - layered)
  const exact = cloudPhase(phase, cosViewLight)
  const towards = clamp(10 * cosViewLight - 9, 0, 1)
  const aureole = aureolePhase(phase, cosViewLight, depthToLight + depthToCamera)
  const single = exact + (aureole - exact) * towards
  const scattered = (phase.scatteringAlbedo / depthScale) * single * Math.exp(-depthToLight)
  return Math.max(diffuse * leak * facing(sample), 0) + scattered
}

/** Depths about a sample between sky and ground. Depths are scaled optical depths along the vertical. */
export interface CloudAmbientSample {
  /** Depth from the sample to the cloud's top. */
  depthAbove: number
  /** Depth from the sample to the cloud's base. */
  depthBelow: number
  /** 1 for a cloud deck (plane-parallel), 0 for an isolated cloud, as wide as it is deep. */
  layered: number
  /** The view ray against the local up. */
  cosView: number
}

/**
 * Source function of light from sky and ground along a view ray, all orders of scattering: radiance per
 * scaled extinction, as the shares of the mean radiances of the hemispheres above and below [1]. Float64 twin
 * of the shader function.
 */
export function cloudAmbient(
  table: Float32Array,
  { depthAbove, depthBelow, layered, cosView }: CloudAmbientSample
): { sky: number; ground: number } {
  const openness = layered + (1 - layered) * ISOLATED_DEPTH
  const [high, low] = [Math.max(depthAbove, 0), Math.max(depthBelow, 0)]
  const [above, below] = [high * openness, low * openness]
  const share = (depth: number, cos: number): number => {
    const [s00, s10, s20] = sampleSkySource(table, depth, above + below)
    return Math.max(s00 + s10 * cos + (s20 * (3 * cos ** 2 - 1)) / 2, 0)
  }
  const slab = { sky: share(above, cosView), ground: share(below, -cosView) }
  const { decay, face, power, slope, thinSlope } = skyShareFit
  const tilt = slope + thinSlope * Math.exp(-decay * (high + low))
  const logit = power * Math.log((low + face) / (high + face)) + tilt * cosView
  const isolated = 1 / (1 + Math.exp(-logit))
  const both = slab.sky + slab.ground
  const sky = layered * slab.sky + (1 - layered) * both * isolated
  return { sky, ground: both - sky }
}

/** Ground below a cloud: `GroundShadeNodes`. Lengths [m]. */
export interface GroundShade {
  depthThrough: number
  layered: number
  radius: number
  altitude: number
  cosLight: number
  albedo: number
}

/** Part of the ground's light that is left below a cloud: `litGround` of light/tsl/cloudLight.ts, by the angle that the disc in shade fills and the sum of all bounces. */
export function litGround(
  phase: CloudPhaseParameters,
  { depthThrough, layered, radius, altitude, cosLight, albedo }: GroundShade
): number {
  const cosine = Math.max(Math.abs(cosLight), 0.12)
  const passed = eddingtonDiffuse(depthThrough * cosine, 1 - scalePhase(phase).moments[1])
  const disc = Math.sin(Math.atan2(radius, altitude / cosine)) ** 2
  const left = passed / (1 - albedo * layered * (1 - passed))
  return 1 - (layered + (1 - layered) * disc) * (1 - left)
}
