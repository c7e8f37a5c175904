import { If, vec4 } from 'three/tsl'
import type { Float, Vec3, Vec4 } from '../../tsl-types'
import type { LayerRay, SkyLayer } from '../../view/SkyLayer'
import type { MediumSegment } from '../../skyVolume/tsl/skyVolume'
import type { ViewNodes } from '../../view/ViewNodes'
import { linearSRGB, transmittanceRGB } from '../../air/tsl/color'
import { volumeSegment, radianceBetween } from '../../skyVolume/tsl/skyVolume'
import { rayLimits } from '../../skyVolume/tsl/rayLimits'

/** Effect of the air between the viewpoint and a point on light from there. */
export interface AerialPerspective {
  /** Factors for linear-sRGB components. */
  transmittance: Vec3
  /** Light added, linear sRGB × `luminanceScale`. */
  inScatter: Vec3
}

/** Medium along a ray: the air, with what layers add to it. */
export function withMedia(
  layers: readonly SkyLayer[],
  ray: LayerRay,
  air: MediumSegment
): MediumSegment {
  return layers.reduce((medium, layer) => layer.medium?.(ray, medium) ?? medium, air)
}

/**
 * Air between the camera and a point, from the sky volume.
 *
 * @param displacementView - Displacement from the camera to the point, in view space [world units].
 * @param layers - Sky layers, and shadows in the air; by default the atmosphere's layers.
 * @param lost - Light that shadows take from it, linear sRGB × `luminanceScale`; by default none.
 */
export function aerialPerspectiveTo(
  view: ViewNodes,
  displacementView: Vec3,
  layers: readonly SkyLayer[] = view.atmosphere.layers,
  lost?: Vec3
): AerialPerspective {
  const { air, volume, viewpoint } = view
  const offset = view.toMapped(displacementView).toConst()
  const square = offset.dot(offset).max(1e-6).toConst() as Float
  const inverse = square.inverseSqrt().toConst()
  const distance = square.mul(inverse).toConst()
  const direction = offset.mul(inverse).toConst()
  const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
  const cosViewLight = direction.dot(view.lightDirection).toConst() as Float
  const limits = rayLimits(viewpoint, cosView)
  const segment = volumeSegment(volume, viewpoint, cosView, limits, distance)
  const sunlit = vec4(0).toVar()
  If(view.isLit.greaterThan(0), () => {
    const between = radianceBetween(air.uniforms, volume, viewpoint, segment, cosViewLight)
    sunlit.assign(between.mul(view.source.irradiance))
  })
  const ray = { view, direction, cosView, cosViewLight, distance, segment }
  const radiance = layers.reduce<Vec4>(
    (without, layer) => layer.inScatter?.(ray, without) ?? without,
    sunlit
  )
  const medium = withMedia(layers, ray, { depth: segment.depth, radiance })
  return {
    transmittance: transmittanceRGB(air.uniforms, medium.depth.negate().exp()),
    inScatter: linearSRGB(air.uniforms, medium.radiance, lost)
  }
}
