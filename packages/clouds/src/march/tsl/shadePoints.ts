import { If, float, step, vec3, vec4 } from 'three/tsl'
import { componentAt } from '../../density/tsl/componentAt'
import { weatherCacheAt } from '../../density/tsl/sampler'
import type { CloudSample } from '../../density/tsl/sample'
import { shade, sourceAt } from '../../light/tsl/lighting'
import type { ShadingContext } from '../../light/tsl/shadingContext'
import { loop, type Float, type Vec3, type Vec4 } from '../../tsl-types'
import { layersAt } from './layerBoundaries'
import { marchClouds, type CloudRay, type MarchedClouds } from './march'
import { POINTS, type SeenPoints } from './seenPoints'

/** Light of a ray's clouds. */
export interface LitRay {
  /** Spectral radiance at the clouds for unit irradiance of the bare sun [1/sr]. */
  readonly radiance: Vec4
}

/** Clouds on a ray, with their light. */
export interface LitClouds extends MarchedClouds, LitRay {}

/**
 * Light of what a ray sees of the clouds, from the points that stand for it. To be called inside of a shader
 * function.
 *
 * @param direction - Direction of the ray, in the mapped space.
 * @returns Spectral radiance at the clouds for unit irradiance of the bare sun [1/sr].
 */
export function shadePoints(
  context: ShadingContext,
  direction: Vec3,
  { distances, shares, lit }: SeenPoints
): Vec4 {
  const { field } = context
  const radiance = vec4(0).toVar() as Vec4
  const seenBefore = float(0).toVar()
  loop('point', POINTS, index => {
    const own = componentAt(float(index))
    const share = shares.dot(own).toConst() as Float
    If(share.greaterThan(0), () => {
      const distance = distances.dot(own).toConst() as Float
      const offset = direction.mul(distance).toConst() as Vec3
      const sample: CloudSample = { offset, ...field.view.localCoordinates(offset), distance }
      const layers = layersAt(field, sample.altitude)
      const weather = weatherCacheAt(field, sample, layers.range, context.weatherMap)
      const transmittance = seenBefore.add(share.mul(0.5)).oneMinus().toConst() as Float
      // Clouds as wide as their layer is thick end there: what is farther is another one.
      const end = distance.add(layers.top.sub(layers.base))
      const past = shares
        .dot(step(distances, vec4(end)))
        .oneMinus()
        .toConst() as Float
      const shaded = {
        sample,
        weather,
        direction,
        transmittance,
        past,
        layers,
        lit: lit?.(own, distance)
      }
      const { direct, sky, ground, fine } = sourceAt(context, shaded)
      const scattered = vec3(direct, sky, ground).mul(share).toConst()
      radiance.addAssign(shade(field, sample, scattered, fine?.mul(share).toConst()))
      seenBefore.addAssign(share)
    })
  })
  return radiance
}

/** Marches a ray and computes its light at once, for pictures that have no pass for either. */
export function litClouds(context: ShadingContext, ray: CloudRay): LitClouds {
  const marched = marchClouds(context, ray)
  const radiance = shadePoints(context, ray.direction, marched.points)
  return { ...marched, radiance }
}
