import { If, mix } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { addHalo, type Halo } from '../../halo/tsl/halo'
import type { Float, Vec4 } from '../../tsl-types'
import type { SkyRay } from '../../view/SkyLayer'
import { corona, moonDisc, type MoonDisc } from './moonDisc'

/** Radius to which the corona is drawn, in radii of the sun. */
export const CORONA_RADII = 12

/** A moon in the sky: its disc, the light of its halo, and the bounds of what has to be drawn. */
export interface MoonSky extends MoonDisc {
  /** Irradiance by the disc above the horizon, over that of the bare sun. */
  irradiance: Vec4
  /** Cosine of the angle from the sun within which an eclipse or the corona can show. */
  cosNearSun: Float
  /** Cosine of the angle from the moon within which its disc or halo can show. */
  cosNearMoon: Float
  /** 0 in totality, else 1. */
  sunVisibility: Float
}

/**
 * Sky beyond the air with a moon in it: the sun's corona, the moon's disc over whatever is behind it,
 * and its halo.
 *
 * @param map - `moonGround` by `moonMapUV`.
 * @param background - Light from farther away [1/sr].
 */
export function moonSky(
  moon: MoonSky,
  map: TextureNode,
  halo: Halo,
  ray: SkyRay,
  background: Vec4
): Vec4 {
  const { direction, pixel, view } = ray
  const { uniforms } = view.air
  const light = background.toVar()
  If(ray.cosViewLight.greaterThan(moon.cosNearSun), () => {
    const sunDistance = direction.sub(view.lightDirection).length().div(uniforms.sunAngularRadius)
    // In totality smoothed edges would let a thousandth of the disc through, which outshines the corona.
    const discRadius = pixel.mul(2).div(uniforms.sunAngularRadius).add(1)
    If(sunDistance.lessThan(discRadius), () => {
      light.mulAssign(moon.sunVisibility)
    })
    If(sunDistance.lessThan(CORONA_RADII), () => {
      light.addAssign(corona(uniforms, sunDistance))
    })
  })
  const { directionMapped } = moon
  const cosMoon = direction.dot(directionMapped).toConst()
  If(cosMoon.greaterThan(moon.cosNearMoon), () => {
    If(direction.sub(directionMapped).length().lessThan(moon.angularRadius.add(pixel)), () => {
      const disc = moonDisc(moon, map, direction, pixel)
      light.assign(mix(light, disc.radiance, disc.coverage))
    })
    addHalo(light, halo, moon.irradiance, direction, directionMapped, cosMoon)
  })
  return light
}
