import { Fn, float, vec2, vec3 } from 'three/tsl'
import type { CloudLight } from '../CloudLightTable'
import { CLOUD_LIGHT_BEND, CLOUD_LIGHT_THICKEST } from '../cpu/cloudLightTable'
import { depths, layers, positions, suns } from '../cpu/cloudLightSize'
import { PUFF_DEPTH } from '../cpu/cloudLight'
import * as c from '../cpu/lateralLeak'
import type { Float, Vec2, Vec4 } from '../../tsl-types'
import { singlePhase } from './cloudPhase'

/** Where a sample is in its cloud. All depths are scaled optical depths τ′ = `light.depthScale` τ. */
export interface CloudSourceNodes {
  /** From the sample to the sun, ≥ 0. */
  depthToSun: Float
  /** Of the whole cloud along the sun's axis through the sample, ≥ `depthToSun`. */
  depthThrough: Float
  /** Of the cloud across the sun's axis: its diameter, for a ball. Of no effect on a layer. */
  depthAcross: Float
  /** From the eye to the sample, in the cloud; left out, the sun's aureole is sharper than it should be. */
  depthToEye?: Float
  /** 1 for a plane-parallel layer, 0 for a cloud that is as wide as it is deep. */
  layered: Float
  /** The sun against the local up. */
  cosSun: Float
  /** The direction that is looked in, against the local up. */
  cosView: Float
  /** Between both. */
  cosViewSun: Float
}

const stretch = (depth: Float): Float => depth.div(CLOUD_LIGHT_BEND).add(1).log()

/** Texture coordinates of a place in a slab. Twins: `slabColumn` and `slabRow` */
function slabPlace(depth: Float, thickness: Float): Vec2 {
  const whole = stretch(thickness.max(1e-4)).toConst()
  const difference = stretch(depth).sub(stretch(thickness.sub(depth)))
  const column = difference.div(whole).mul(0.5).add(0.5).clamp()
  const row = whole.div(Math.log1p(CLOUD_LIGHT_THICKEST / CLOUD_LIGHT_BEND)).clamp()
  return vec2(
    column
      .mul(positions - 1)
      .add(0.5)
      .div(positions),
    row
      .mul(depths - 1)
      .add(0.5)
      .div(depths)
  )
}

/** Reads a layer of the table. */
const read = ({ table }: CloudLight, place: Vec2, layer: Float): Vec4 =>
  table
    .sample(vec3(place, layer.add(0.5).div(layers)))
    .level(0)
    .toConst()

/** x + y μ + z (3μ² − 1)/2. */
const series = ({ x, y, z }: Vec4, cosine: Float): Float =>
  x.add(y.mul(cosine)).add(z.mul(cosine.mul(cosine).mul(1.5).sub(0.5)))

/** Share of a slab's multiply scattered light that a ball keeps. Twin: `lateralLeak` */
function lateralLeak(light: CloudLight, sample: CloudSourceNodes): Float {
  const { depthToSun, depthThrough, depthAcross, layered } = sample
  const part = depthToSun.div(depthThrough.max(1e-4)).clamp().toConst()
  const depth = light.diffusing.mul(depthAcross.min(c.deepestPuff)).add(1).log().toConst()
  const chord = depthThrough.div(depthAcross.max(1e-4)).clamp().toConst()
  const byPart = part.mul(c.part2).add(depth.mul(c.partDepth)).add(chord.mul(c.partChord))
  const byDepth = depth.mul(c.depth2).add(chord.mul(c.depthChord)).add(c.depth)
  return byPart
    .add(c.part)
    .mul(part)
    .add(byDepth.mul(depth))
    .add(chord.mul(c.chord2).add(c.chord).mul(chord))
    .add(c.constant)
    .mul(layered.oneMinus())
    .exp()
}

/**
 * Sunlight scattered into the direction that is looked in, any number of times: radiance per scaled
 * extinction, for unit irradiance of the sun above the cloud [1/sr].
 *
 * Light scattered once has the exact phase function and scaled depths (TMS); light scattered more than
 * once comes from the table of slabs, less what a cloud that is no layer loses through its sides. March
 * in scaled depths: L = ∫ S e^{−τ′} dτ′, with the same e^{−τ′} for what is behind the cloud.
 *
 * Twin: cpu/cloudLight.ts
 *
 * @see Nakajima & Tanaka 1988, "Algorithms for radiative intensity calculations" (TMS)
 */
export function cloudSource(light: CloudLight, sample: CloudSourceNodes): Float {
  const { depthToSun, depthThrough, depthToEye, layered, cosViewSun } = sample
  return Fn(() => {
    const lone = layered.oneMinus().toConst()
    // The slab's normal: up (or down, under a low sun) for layers, towards the sun for lone clouds.
    const side = sample.cosSun.lessThan(0).select(-1, 1).mul(layered).toConst()
    const lift = side.mul(sample.cosSun).toConst()
    const scale = layered
      .mul(layered)
      .add(lone.mul(lone))
      .add(lift.mul(lone).mul(2))
      .inverseSqrt()
      .toConst()
    const cosSun = lift.add(lone).mul(scale).clamp().toConst()
    const cosView = side.mul(sample.cosView).add(lone.mul(cosViewSun)).mul(scale).toConst()
    const thickness = depthThrough.mul(cosSun).toConst()
    const depth = depthToSun.mul(cosSun).clamp(0, thickness).toConst()
    const place = slabPlace(depth, thickness).toConst()
    const sun = cosSun.mul(suns - 1).toConst()
    const first = read(light, place, sun)
    const second = read(light, place, sun.add(suns))
    const along = cosViewSun.sub(cosView.mul(cosSun)).toConst()
    const sines = cosView.mul(cosView).oneMinus().mul(cosSun.mul(cosSun).oneMinus())
    const diffuse = series(first, cosView)
      .add(first.w.add(second.x.mul(cosView)).mul(along))
      .add(second.y.mul(along.mul(along).mul(2).sub(sines)))
    const path = depthToEye === undefined ? depthToSun : depthToSun.add(depthToEye)
    const single = singlePhase(light, cosViewSun, path)
      .mul(light.scatteringScale)
      .mul(depthToSun.negate().exp())
    return diffuse.mul(lateralLeak(light, sample)).max(0).add(single)
  })()
}

/** Where a sample is between sky and ground. Depths are scaled optical depths along the vertical. */
export interface CloudAmbientNodes {
  /** From the sample to the cloud's top. */
  depthAbove: Float
  /** From the sample to its base. */
  depthBelow: Float
  /** 1 for a plane-parallel layer, 0 for a cloud that is as wide as it is deep. */
  layered: Float
  /** The direction that is looked in, against the local up. */
  cosView: Float
}

/**
 * Light of sky and ground scattered into the direction that is looked in, any number of times: radiance
 * per scaled extinction, for a mean radiance of 1 of the upper or of the lower hemisphere.
 */
export function cloudAmbientShares(
  light: CloudLight,
  { depthAbove, depthBelow, layered, cosView }: CloudAmbientNodes
): { sky: Float; ground: Float } {
  const openness = layered
    .mul(1 - PUFF_DEPTH)
    .add(PUFF_DEPTH)
    .toConst()
  const above = depthAbove.max(0).mul(openness).toConst()
  const below = depthBelow.max(0).mul(openness).toConst()
  const place = slabPlace(above, above.add(below)).toConst()
  const at = (uv: Vec2, cosine: Float): Float =>
    series(read(light, uv, float(2 * suns)), cosine)
      .max(0)
      .toConst()
  return {
    sky: at(place, cosView),
    // The same slab seen from below.
    ground: at(vec2(place.x.oneMinus(), place.y), cosView.negate().toConst())
  }
}

/**
 * Light of sky and ground scattered into the direction that is looked in, any number of times:
 * radiance per scaled extinction. Twin: cpu/cloudLight.ts
 *
 * @param sky - Mean radiance of the upper hemisphere: irradiance from above over π.
 * @param ground - Mean radiance of the lower hemisphere: irradiance from below over π.
 */
export function cloudAmbient(
  light: CloudLight,
  sample: CloudAmbientNodes,
  sky: Vec4,
  ground: Vec4
): Vec4 {
  return Fn(() => {
    const shares = cloudAmbientShares(light, sample)
    return sky.mul(shares.sky).add(ground.mul(shares.ground))
  })()
}
