import { Fn, float, mix, vec2 } from 'three/tsl'
import { select } from '../../select'
import type { CloudLight } from '../CloudLightTable'
import { skyShareFit as fit } from '../cpu/skyShare'
import { slabTableForm } from '../cpu/slabTableForm'
import type { Float, Vec2 } from '../../tsl-types'
import { singlePhase } from './cloudPhase'
import { facing, type FacingNodes } from './facing'
import { flow } from './flow'
import { lateralLeak } from './lateralLeak'
import { legendreSeries, readLayer, slabCoordinates } from './slabTable'

/** Depths about a sample in its cloud. All depths are scaled optical depths τ′ = `light.depthScale` τ. */
export interface CloudSourceNodes extends FacingNodes {
  /** Depth from the viewpoint to the sample, in the cloud. */
  depthToCamera: Float
  /** The light against the local up. */
  cosLight: Float
  /** The view ray against the local up. */
  cosView: Float
  /** Between both. */
  cosViewLight: Float
}

/**
 * Source function of sun- or moonlight along a view ray, all orders of scattering: radiance per scaled
 * extinction, for unit irradiance above the cloud [1/sr].
 *
 * Light scattered once has the exact phase function and scaled depths (TMS); light scattered more than
 * once comes from the table of slabs, less what an isolated cloud loses through its sides, and by the cosine of the light
 * on the faces of a thick one. March
 * in scaled depths: L = ∫ S e^{−τ′} dτ′, with the same e^{−τ′} for what is behind the cloud.
 *
 * Twin: test/twins/cloudLight.ts
 *
 * @see Stamnes, Tsay, Wiscombe & Laszlo 2000, "DISORT, a general-purpose Fortran program for
 *   discrete-ordinate-method radiative transfer", §3.6 (TMS), after Nakajima & Tanaka 1988, "Algorithms for radiative
 *   intensity calculations in moderately thick atmospheres using a truncation approximation"
 */
export function cloudSource(light: CloudLight, sample: CloudSourceNodes): Float {
  const { depthToLight, depthThrough, depthToCamera, layered, cosViewLight } = sample
  return Fn(() => {
    const isolated = layered.oneMinus().toConst()
    // The slab's normal: up (or down, under a light below the horizon) for decks, towards the light for isolated clouds.
    const side = select(sample.cosLight.lessThan(0), -1, 1).mul(layered).toConst()
    const lift = side.mul(sample.cosLight).toConst()
    const scale = layered
      .mul(layered)
      .add(isolated.mul(isolated))
      .add(lift.mul(isolated).mul(2))
      .inverseSqrt()
      .toConst()
    const cosSlabLight = lift.add(isolated).mul(scale).clamp().toConst()
    const cosView = side.mul(sample.cosView).add(isolated.mul(cosViewLight)).mul(scale).toConst()
    const thickness = depthThrough.mul(cosSlabLight).toConst()
    const depth = depthToLight.mul(cosSlabLight).clamp(0, thickness).toConst()
    const uv = slabCoordinates(depth, thickness).toConst()
    const layer = cosSlabLight.mul(slabTableForm.lightAngles - 1).toConst()
    const first = readLayer(light, uv, layer)
    const second = readLayer(light, uv, layer.add(slabTableForm.lightAngles))
    const along = cosViewLight.sub(cosView.mul(cosSlabLight)).toConst()
    const sines = cosView.mul(cosView).oneMinus().mul(cosSlabLight.mul(cosSlabLight).oneMinus())
    const diffuse = legendreSeries(first, cosView)
      .add(first.w.add(second.x.mul(cosView)).mul(along))
      .add(second.y.mul(along.mul(along).mul(2).sub(sines)))
      .add(flow(light, sample, cosView, cosViewLight).mul(first.x).mul(isolated))
    const single = singlePhase(light, cosViewLight, depthToLight.add(depthToCamera))
      .mul(light.scatteringScale)
      .mul(depthToLight.negate().exp())
    const kept = lateralLeak(light, sample).mul(facing(sample, cosViewLight))
    return diffuse.mul(kept).max(0).add(single)
  })()
}

/**
 * Thickness of the slab that absorbs as much of the light of sky and ground as an isolated cloud, as a part of that
 * cloud's: light enters it from its sides, too.
 */
export const ISOLATED_DEPTH = 0.2

/** Ground below a cloud. Lengths [m]. */
export interface GroundShadeNodes {
  /** Scaled optical depth of the cloud on a ray of light. */
  depthThrough: Float
  /** 1 for a cloud deck, 0 for an isolated cloud. */
  layered: Float
  /** Radius of an isolated cloud. */
  radius: Float
  /** Altitude of the sample. */
  altitude: Float
  /** The light against the local up. */
  cosLight: Float
  /** Albedo of the ground, in [0, 1]. */
  albedo: Float
}

/** Cosine of the lowest light whose rays grow longer, and shadows fall farther aside, with its height. */
export const LOWEST_COSINE = 0.12

/**
 * Part of the ground's light that is left below a cloud, in [0, 1]: ground in its shade is dark. A cloud lets Eddington's
 * transmittance t = 1/(1 + ¾ (1 − g′) τ′) through. Below an isolated one that falls on a disc of its own size, which is so far away along
 * the light and fills r²/(r² + d²) of the view down (form factor of a disc); below a deck, on all of the view. Between deck and
 * ground of albedo A light goes to and fro: t/(1 − A (1 − t)) is left. Twin: test/twins/cloudLight.ts
 */
export function litGround(
  light: CloudLight,
  { depthThrough, layered, radius, altitude, cosLight, albedo }: GroundShadeNodes
): Float {
  const cosine = cosLight.abs().max(LOWEST_COSINE).toConst() as Float
  const kept = albedo.mul(layered).oneMinus()
  const slab = light.oneMinusAsymmetry.mul(0.75).mul(depthThrough).mul(cosine).mul(kept).toConst()
  const distance = altitude.div(cosine.mul(radius)).toConst()
  const shaded = layered.mix(distance.mul(distance).add(1).reciprocal(), 1)
  return slab.div(slab.add(1)).mul(shaded).oneMinus()
}

/** Depths about a sample between sky and ground. Depths are scaled optical depths along the vertical. */
export interface CloudAmbientNodes {
  /** Depth from the sample to the cloud's top. */
  depthAbove: Float
  /** Depth from the sample to the cloud's base. */
  depthBelow: Float
  /** 1 for a cloud deck, 0 for an isolated cloud. */
  layered: Float
  /** The view ray against the local up. */
  cosView: Float
  /** 1 where clouds are resolved one by one, 0 where not, whose mean depths are a slab's; left out, 1. */
  resolved?: Float
}

/**
 * Source function of light from sky and ground along a view ray, all orders of scattering: radiance per
 * scaled extinction, for a mean radiance of 1 of the upper or of the lower hemisphere. Twin: test/twins/cloudLight.ts
 */
export function cloudAmbientShares(
  light: CloudLight,
  { depthAbove, depthBelow, layered, cosView, resolved = float(1) }: CloudAmbientNodes
): { sky: Float; ground: Float } {
  const openness = layered
    .mul(1 - ISOLATED_DEPTH)
    .add(ISOLATED_DEPTH)
    .toConst()
  const [high, low] = [depthAbove, depthBelow].map(depth => depth.max(0).toConst() as Float)
  const above = high.mul(openness).toConst()
  const below = low.mul(openness).toConst()
  const uv = slabCoordinates(above, above.add(below)).toConst()
  const at = (coordinates: Vec2, cosine: Float): Float =>
    legendreSeries(readLayer(light, coordinates, float(2 * slabTableForm.lightAngles)), cosine)
      .max(0)
      .toConst()
  const sky = at(uv, cosView)
  // The same slab seen from below.
  const ground = at(vec2(uv.x.oneMinus(), uv.y), cosView.negate().toConst())
  const slope = high.add(low).mul(-fit.decay).exp().mul(fit.thinSlope).add(fit.slope)
  const ratio = low.add(fit.face).div(high.add(fit.face))
  const share = ratio
    .log()
    .mul(fit.power)
    .add(slope.mul(cosView))
    .negate()
    .exp()
    .add(1)
    .reciprocal()
  const both = sky.add(ground).toConst()
  const skyShare = mix(sky, both.mul(share), layered.oneMinus().mul(resolved)).toConst()
  return { sky: skyShare, ground: both.sub(skyShare).toConst() }
}
