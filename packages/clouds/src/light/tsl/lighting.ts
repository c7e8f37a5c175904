import { horizontalIrradiance, transmittanceToSun } from '@welkin/atmosphere'
import { If, float, int, smoothstep, vec4 } from 'three/tsl'
import type { CloudField } from '../../density/CloudField'
import type { CloudLight } from '../CloudLightTable'
import type { QualityUniforms } from '../../march/quality'
import { loop, type Float, type Int, type Vec3, type Vec4 } from '../../tsl-types'
import { cloudAmbientShares, cloudSource } from './cloudLight'
import { extinctionNearby, type WeatherCache } from '../../density/tsl/sampler'
import type { CloudSample } from '../../density/tsl/sample'
import { isNight, nightShare } from './night'
import { sampleShadows, type CloudShadows } from '../../shadow/tsl/sampleShadows'
import type { LayersAt } from '../../march/tsl/layerBoundaries'

/** A sun lower than this does not make its rays any longer. */
const LOWEST_COSINE = 0.12

/** How far towards the sun clouds are looked at themselves: per distance, at least and at most [m]. */
const REACH_GROWTH = 0.02
const LEAST_REACH = 60
const MOST_REACH = 600

/** Under a low sun, rays stay among clouds for longer: cosines that count, reach [m], and more samples. */
const LOW_SUN = 0.35
const LOWEST_SUN = 0.12
const LOW_SUN_REACH = 700
const LOW_SUN_SAMPLES = 2

/** Part of the way to the top at which the cloud above is looked at. */
const UPWARDS = 0.35

/** Transmittance below which nothing is seen. */
export const OPAQUE = 0.01

/** What shading needs to know, the same for all rays of a picture. */
export interface ShadingContext {
  readonly field: CloudField
  readonly light: CloudLight
  readonly shadows: CloudShadows
  readonly quality: QualityUniforms
}

/** A place in the clouds that is to be shaded. */
export interface ShadedSample {
  readonly sample: CloudSample
  readonly weather: WeatherCache
  /** Direction of the ray on which it is seen, unit length, in the mapped space. */
  readonly direction: Vec3
  /** Transmittance of the clouds between it and the camera, in [0, 1]. */
  readonly transmittance: Float
  /** Noise in [0, 1), in which cascades of the shadow map meet. */
  readonly dither: Float
  /** The layers around it. */
  readonly layers: Pick<LayersAt, 'base' | 'top' | 'layered'>
}

/** The light that clouds are shaded for: sun or moon. */
interface Lamp {
  /** Direction to it, unit length, in the mapped space. */
  readonly direction: Vec3
  /** 1 if the shadow maps are of this light, else 0. */
  readonly isMapped: Float
  /** Cosine between it and the zenith. */
  readonly cosine: Float
}

/** Optical depths about a sample, not scaled. */
interface Depths {
  toSun: Float
  /** Of all clouds on the sun ray through the sample. */
  through: Float
  above: Float
  below: Float
}

/**
 * Optical depths about a sample: a few samples near it, which see what is smaller than the shadow map's
 * texels, and the map beyond. Where there is no map, the cloud is taken to be as dense as it is near.
 */
function depthsAbout(
  { field, shadows, quality }: ShadingContext,
  { sample, weather, dither, layers: { base, top } }: ShadedSample,
  { direction: toLight, isMapped, cosine: cosSun }: Lamp
): Depths {
  const rise = top.sub(sample.altitude).max(1).toConst()
  const fall = sample.altitude.sub(base).max(1).toConst()
  const slant = cosSun.abs().max(LOWEST_COSINE).reciprocal().toConst()
  const toTop = cosSun.greaterThan(0).select(rise, fall).mul(slant).toConst() as Float
  const lowness = smoothstep(-LOW_SUN, -LOWEST_SUN, cosSun.abs().negate()).toConst() as Float
  const reach = sample.distance
    .mul(REACH_GROWTH)
    .clamp(LEAST_REACH, MOST_REACH)
    .max(lowness.mul(LOW_SUN_REACH))
    .min(toTop)
    .toConst() as Float
  /** Nearest, sum towards the sun, upwards. */
  const found = vec4(0).toVar() as Vec4
  const more = lowness.mul(LOW_SUN_SAMPLES).ceil().toInt()
  const count = quality.sunSteps.add(more).toConst() as Int
  // One instance of the density for both directions: shaders stay short.
  loop('probe', count.add(int(1)), index => {
    const isUpwards = index.equal(count).toConst()
    // Steps grow from the sample on: (i/n)² of the way.
    const from = float(index).div(float(count)).toConst() as Float
    const to = float(index).add(1).div(float(count)).toConst() as Float
    const [start, end] = [from.mul(from).mul(reach), to.mul(to).mul(reach)]
    const middle = isUpwards.select(rise.mul(UPWARDS), start.add(end).mul(0.5)).toConst() as Float
    const direction = isUpwards.select(sample.up, toLight) as Vec3
    const offset = sample.offset.add(direction.mul(middle)).toConst() as Vec3
    const { altitude, up } = field.view.place(offset)
    const { distance } = sample
    const extinction = extinctionNearby(field, weather, { offset, altitude, up, distance })
    found.addAssign(
      isUpwards.select(
        vec4(0, 0, extinction, 0),
        vec4(index.equal(int(0)).select(extinction, 0), extinction.mul(end.sub(start)), 0, 0)
      )
    )
  })
  const beyond = sample.offset.add(toLight.mul(reach)).toConst() as Vec3
  const far = sampleShadows(shadows, beyond, dither)
  const known = far.known.mul(isMapped).toConst() as Float
  // Where no map is: as near, thinning out towards the top.
  const density = found.y.div(reach).toConst()
  const guess = density.mul(toTop.sub(reach)).toConst()
  const toSun = found.y.add(known.mix(guess, far.toLight)).toConst() as Float
  const behind = cosSun.greaterThan(0).select(fall, rise).mul(slant).mul(density)
  const through = known.mix(toSun.add(behind), far.through.max(toSun)).toConst() as Float
  const above = rise.mul(found.x.mul(UPWARDS / 2).add(found.z.mul(0.5)))
  return { toSun, through, above, below: fall.mul(found.x).mul(0.7) }
}

/** Shares of light in a place's source function: per scaled extinction [1/sr, 1, 1]. */
export interface CloudShares {
  /** Of the irradiance of the sun, or of the moon where that is the light. */
  sun: Float
  /** Of the mean radiance of the upper and the lower hemisphere. */
  sky: Float
  ground: Float
}

/** What a place sends towards the eye of the light that reaches it. */
export function sourceAt(context: ShadingContext, place: ShadedSample): CloudShares {
  const { field, light, shadows } = context
  const { sample, direction, transmittance } = place
  const { view } = field
  const isDark = isNight(field, sample.up.dot(view.sunDirection)).toConst()
  const toLight = isDark.select(field.night.direction, view.sunDirection).toConst() as Vec3
  const isMapped = isDark.select(shadows.isMoonlit, shadows.isMoonlit.oneMinus()) as Float
  const cosSun = sample.up.dot(toLight).clamp(-1, 1).toConst() as Float
  const cosView = sample.up.dot(direction).clamp(-1, 1).toConst() as Float
  const cosViewSun = direction.dot(toLight).clamp(-1, 1).toConst() as Float
  const depths = depthsAbout(context, place, { direction: toLight, isMapped, cosine: cosSun })
  const scale = light.depthScale
  const layered = place.layers.layered.toConst() as Float
  const depthThrough = depths.through.mul(scale).toConst() as Float
  const sun = cloudSource(light, {
    depthToSun: depths.toSun.mul(scale).toConst(),
    depthThrough,
    depthAcross: depthThrough,
    depthToEye: transmittance.max(OPAQUE).log().negate().toConst(),
    layered,
    cosSun,
    cosView,
    cosViewSun
  })
  const ambient = cloudAmbientShares(light, {
    depthAbove: depths.above.mul(scale),
    depthBelow: depths.below.mul(scale),
    layered,
    cosView
  })
  return { sun, sky: ambient.sky, ground: ambient.ground }
}

/**
 * Spectral radiance of clouds about a place in the light of sun, moon and night sky, over the sun's
 * irradiance above the air [1/sr].
 *
 * @param shares - Sums of `CloudShares`.
 */
export function shade(field: CloudField, { altitude, up }: CloudSample, shares: Vec3): Vec4 {
  const { view } = field
  const { uniforms, transmittance, diffuse } = view.air
  const { night } = field
  const litFrom = (direction: Vec3): { cosine: Float; light: Vec4 } => {
    const cosine = up.dot(direction).clamp(-1, 1).toConst() as Float
    const direct = transmittanceToSun(uniforms, transmittance, altitude, cosine).mul(shares.x)
    if (diffuse === null) return { cosine, light: direct }
    const irradiance = horizontalIrradiance(uniforms, diffuse, altitude, cosine)
    const ambient = irradiance.up.mul(shares.y).add(irradiance.down.mul(shares.z))
    return { cosine, light: direct.add(ambient.div(Math.PI)) }
  }
  const sun = litFrom(view.sunDirection)
  const light = sun.light.mul(view.source.irradiance).toVar() as Vec4
  If(isNight(field, sun.cosine), () => {
    const moonlight = litFrom(night.direction).light.mul(night.irradiance)
    const sky = night.radiance.mul(uniforms.groundAlbedo.mul(shares.z).add(shares.y))
    light.addAssign(moonlight.add(sky).mul(nightShare(field, sun.cosine)))
  })
  return light
}
