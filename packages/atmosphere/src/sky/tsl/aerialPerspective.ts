import { If, vec4 } from 'three/tsl'
import type { Float, Vec3, Vec4 } from '../../tsl-types'
import type { Sightline, SkyLayer, Veil } from '../../view/SkyLayer'
import type { ViewNodes } from '../../view/ViewNodes'
import { linearSRGB, transmittanceRGB } from '../../air/tsl/color'
import { placeInVolume, radianceBetween, rayLimits } from '../../skyVolume/tsl/skyVolume'

/** Effect of the air between the viewpoint and a point on light from there. */
export interface AerialPerspective {
  /** Factors for linear-sRGB components. */
  transmittance: Vec3
  /** Light added, linear sRGB × `luminanceScale`. */
  inScatter: Vec3
}

/** What the layers of the atmosphere make of the air's veil. */
export function veiled(layers: readonly SkyLayer[], line: Sightline, air: Veil): Veil {
  return layers.reduce((veil, layer) => layer.veil?.(line, veil) ?? veil, air)
}

/**
 * Air between the camera and a point, from the sky volume.
 *
 * @param displacementView - From the camera to the point, in view space [world units].
 */
export function aerialPerspectiveTo(view: ViewNodes, displacementView: Vec3): AerialPerspective {
  const { air, volume, eye } = view
  const { layers } = view.atmosphere
  const offset = view.toMapped(displacementView).toConst()
  const square = offset.dot(offset).max(1e-6).toConst() as Float
  const inverse = square.inverseSqrt().toConst()
  const distance = square.mul(inverse).toConst()
  const direction = offset.mul(inverse).toConst()
  const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
  const cosViewSun = direction.dot(view.sunDirection).toConst() as Float
  const limits = rayLimits(eye, cosView)
  const place = placeInVolume(volume, eye, cosView, limits, distance)
  const sunlit = vec4(0).toVar()
  If(view.isLit.greaterThan(0), () => {
    const between = radianceBetween(air.uniforms, volume, eye, place, cosViewSun)
    sunlit.assign(between.mul(view.source.irradiance))
  })
  const line = { view, direction, cosView, cosViewSun, distance, place }
  const light = layers.reduce<Vec4>(
    (without, layer) => layer.haze?.(line, without) ?? without,
    sunlit
  )
  const veil = veiled(layers, line, { depth: place.depth, light })
  return {
    transmittance: transmittanceRGB(air.uniforms, veil.depth.negate().exp()),
    inScatter: linearSRGB(air.uniforms, veil.light)
  }
}
