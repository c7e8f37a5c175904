import { aerialPerspectiveTo, linearSRGB } from '@welkin/atmosphere'
import type { ViewNodes } from '@welkin/atmosphere'
import { If, vec4 } from 'three/tsl'
import type { Float, Vec3, Vec4 } from '../../tsl-types'
import type { LitClouds } from './shadePoints'

/**
 * Marched clouds behind their air: linear light, dimmed by the air in front of them and with its
 * in-scatter, times a gain; transmittance in alpha. To be called inside of a shader function.
 *
 * @param directionView - View ray in view space, for each metre of the mapped space [world units/m].
 */
export function withAerialPerspective(
  view: ViewNodes,
  { radiance, transmittance, distance }: Pick<LitClouds, 'radiance' | 'transmittance' | 'distance'>,
  directionView: Vec3,
  gain: Float
): Vec4 {
  const color = vec4(0, 0, 0, transmittance).toVar() as Vec4
  const opacity = transmittance.oneMinus().toConst()
  If(opacity.greaterThan(0), () => {
    // Shafts are taken from the picture when clouds are in it, with no history.
    const layers = view.atmosphere.layers.filter(layer => !('upTo' in layer))
    const air = aerialPerspectiveTo(view, directionView.mul(distance).toConst(), layers)
    const spectral = linearSRGB(view.air.uniforms, radiance)
    const seen = spectral.mul(air.transmittance).add(air.inScatter.mul(opacity))
    color.assign(vec4(seen.mul(gain), transmittance))
  })
  return color
}
