import { cross, vec2 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { OrthographicCamera } from 'three'
import type { DepthRays } from '../../view/DepthRays'
import type { Float, Vec2, Vec3 } from '../../tsl-types'

/** Error of a side that lies outside of the picture. */
const OUTSIDE = 1e30

/**
 * Normal of the surface that a picture's depth has at a place, towards the camera, in view space.
 *
 * Differences of positions along both axes, each to the side whose next two pixels are more nearly on one plane with this
 * one, so that normals are sharp at edges. Normals of planes are exact.
 *
 * @param rays - Depth and camera of the picture.
 * @param at - Middle of a texel of the depth, as texture coordinates.
 * @param size - Size of the depth [texels].
 * @returns Unit vector; zero for what is smaller than a pixel and seen edge-on.
 * @see three's `getNormalFromDepth`, which compares depths in place of positions. Twin: test/twins/lights/depthNormal.ts
 */
export function depthNormal(renderer: Renderer, rays: DepthRays, at: Vec2, size: Vec2): Vec3 {
  const { isOrthographicCamera } = rays.camera as OrthographicCamera
  const positionAt = (place: Vec2): Vec3 => rays.position(renderer, place, rays.depthAt(place))
  // On a plane this changes evenly across a picture.
  const even = ({ z }: Vec3): Float => (isOrthographicCamera ? z : z.reciprocal())
  const here = positionAt(at)
  const slope = (axis: Vec2): Vec3 => {
    const step = axis.div(size).toConst() as Vec2
    const [before, after] = [-1, 1].map(sign => {
      const [one, two] = [1, 2].map(n => at.add(step.mul(sign * n)).toConst() as Vec2)
      const next = positionAt(one)
      const bend = even(next)
        .mul(2)
        .sub(even(positionAt(two)))
        .sub(even(here))
        .abs()
      const isInside = two.sub(two.clamp()).length().equal(0)
      return { next, error: isInside.select(bend, OUTSIDE).toConst() }
    })
    return before.error
      .lessThan(after.error)
      .select(here.sub(before.next), after.next.sub(here))
      .toConst()
  }
  const normal = cross(slope(vec2(1, 0)), slope(vec2(0, -1))).toConst() as Vec3
  return normal.div(normal.length().max(1e-30)).toConst()
}
