import { Fn, screenUV, textureSize, vec2 } from 'three/tsl'
import type { DepthRays } from '../../view/DepthRays'
import type { Vec2, Vec3 } from '../../tsl-types'
import { depthNormal } from './depthNormal'

/** Middle of the depth's texel at a fragment, and the depth's size. */
function texelHere({ depthNode }: DepthRays): { at: Vec2; size: Vec2 } {
  const size = vec2(textureSize(depthNode, 0 as never) as never).toConst() as Vec2
  return { at: screenUV.mul(size).floor().add(0.5).div(size).toConst(), size }
}

/** Position of the surface that a picture's depth has at a fragment, in view space [world units]. */
export const depthPositionHere = (rays: DepthRays): Vec3 =>
  Fn(({ renderer }): Vec3 => {
    const { at } = texelHere(rays)
    return rays.at(renderer, at).position
  })()

/** Its normal, in view space. */
export const depthNormalHere = (rays: DepthRays): Vec3 =>
  Fn(({ renderer }): Vec3 => {
    const { at, size } = texelHere(rays)
    return depthNormal(renderer, rays, at, size)
  })()
