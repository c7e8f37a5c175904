import { vec3 } from 'three/tsl'
import type { Float, Vec2, Vec3 } from '../../tsl-types'
import type { SkyRay } from '../../view/SkyLayer'
import { equirectangular, equirectangularStep } from './equirectangular'
import type { GroundAngles } from './groundReflection'

/** Smallest pixel that textures are filtered for, where the size of pixels is not known [rad]. */
const MIN_PIXEL_ANGLE = 2e-4

/** Point where a view ray hits the ground, and the size of a pixel there. */
export interface GroundHit {
  angles: GroundAngles
  /** Geodetic normal, ECEF axes, unit length. */
  normal: Vec3
  /** Width of a pixel on the ground, in units of the radius. */
  footprint: Float
  /** Equirectangular texture coordinates. */
  uv: Vec2
  /** Their change across a pixel. */
  uvAcross: Vec2
  /** Their change along a pixel, in the direction of view. */
  uvAlong: Vec2
}

/**
 * Ground that a view ray hits.
 *
 * @param distance - Camera to the ground [m].
 * @param flattening - Polar over equatorial radius: geodetic normals from directions of the mapped sphere.
 */
export function groundHit(
  { view, direction, cosViewLight, pixel }: SkyRay,
  distance: Float,
  flattening: Float
): GroundHit {
  const { bottomRadius } = view.air.uniforms
  const hit = view.up.mul(bottomRadius.add(view.viewpoint.altitude)).add(direction.mul(distance))
  const up = hit.normalize().toConst() as Vec3
  const cosViewer = direction.dot(up).negate().clamp(1e-3, 1).toConst() as Float
  // A pixel on the ground, in units of the radius: across the view ray and along it.
  const width = pixel.max(MIN_PIXEL_ANGLE).mul(distance).div(bottomRadius).toConst()
  const side = direction.cross(up).toConst()
  const across = side.div(side.length().max(1e-6)).mul(width).toConst() as Vec3
  const along = up.cross(across).div(cosViewer.max(0.02)).toConst() as Vec3
  const normal = up
    .mul(vec3(flattening, flattening, 1))
    .normalize()
    .toConst() as Vec3
  return {
    angles: {
      cosLight: up.dot(view.lightDirection).clamp(-1, 1).toConst(),
      cosViewer,
      cosLightViewer: cosViewLight.negate()
    },
    normal,
    footprint: width.div(cosViewer.max(0.1).sqrt()),
    uv: equirectangular(normal).toConst(),
    uvAcross: equirectangularStep(normal, across).toConst(),
    uvAlong: equirectangularStep(normal, along).toConst()
  }
}
