import type { DepthTexture, Matrix4, Vector2, Vector4 } from 'three'
import { Fn, If, float, step, uv, vec2, vec4 } from 'three/tsl'
import type { TextureNode, UniformNode } from 'three/webgpu'
import {
  gatherRed,
  loop,
  type Bool,
  type Float,
  type Vec2,
  type Vec3,
  type Vec4
} from '../../tsl-types'
import { bilinear, lightRayAt, MOST_COTANGENT, type PolarFrame } from './polarMap'

/** A shadow map of a light as the shader that merges them sees it. */
export interface ShadowMapNodes {
  readonly depth: TextureNode & { value: DepthTexture }
  /** Size of the texture [texels]. */
  readonly size: UniformNode<'vec2', Vector2>
  /** Displacements from the camera in the mapped space [m] to the map's coordinates. */
  readonly matrix: UniformNode<'mat4', Matrix4>
  /** First coordinates that are the map's, and last: a part of the texture where maps share one. */
  readonly bounds: UniformNode<'vec4', Vector4>
  /** Distance towards the light per unit of stored depth [m]. */
  readonly metersPerDepth: UniformNode<'float', number>
}

/** Encoding of a renderer's depths. */
export interface DepthStorage {
  /** Greater is nearer. */
  readonly isReversed: boolean
  /** Depths can be read only by comparing: in WebGL, from textures made for that. */
  readonly isCompared: boolean
}

/** Comparisons that find a depth: to 2⁻¹⁶ of the map's range. */
const COMPARISONS = 16

/** Position of an occluder that is not there [m]. */
const NOTHING = -1e30

/** Part of the map's range at its far end that is taken to be empty. */
const EMPTY = 3e-5

/** Depth by bisection, where a texture can only be compared with. */
function comparedDepth(depth: TextureNode, at: Vec2, { isReversed }: DepthStorage): Float {
  const low = float(0).toVar()
  const width = float(0.5).toVar()
  // A sample of the node, not of its texture now: three makes another when a light casts shadows anew.
  const compared = depth.sample(at) as unknown as { compare(to: Float): Vec4 }
  loop('comparison', COMPARISONS, () => {
    const middle = low.add(width).toConst() as Float
    const passes = compared.compare(middle).r.greaterThan(0.5)
    If(isReversed ? passes.not() : passes, () => {
      low.assign(middle)
    })
    width.mulAssign(0.5)
  })
  return low
}

/** True where nothing casts a shadow. */
const isEmpty = (stored: Float, { isReversed }: DepthStorage): Bool =>
  isReversed ? stored.lessThanEqual(EMPTY) : stored.greaterThanEqual(1 - EMPTY)

/**
 * Depth between the four texels next to a place, so that slopes in shadow at a flat angle cast no shadows in
 * steps; of the nearest one where a caster ends, which would shrink.
 */
function mixedDepth(depth: TextureNode, size: Vec2, at: Vec2, { isReversed }: DepthStorage): Float {
  const place = at.mul(size).sub(0.5).toConst()
  const first = place.floor().toConst()
  const part = place.sub(first).toConst()
  const four = gatherRed(depth, first.add(1).div(size))
  const among = (weight: Vec2): Float => bilinear(four, weight)
  const { x, y, z, w } = four
  const farther = isReversed ? 'min' : 'max'
  const farthest = x[farther](y)[farther](z)[farther](w)
  return isEmpty(farthest, { isReversed, isCompared: false })
    .select(among(step(0.5, part)), among(part))
    .toConst()
}

/**
 * A texel of the sun-polar shadow map: its ray of light through the shadow maps, up to the first that has an
 * occluder on it.
 *
 * @param maps - Shadow maps from the finest on, as cascades are.
 * @returns Cotangent of the occluder's angle from the source of light; the least where there is none.
 */
export function occluderAngle(
  frame: PolarFrame,
  maps: readonly ShadowMapNodes[],
  storage: DepthStorage
): Vec4 {
  return Fn(() => {
    const texel = uv() as unknown as Vec2
    const { offset, distance } = lightRayAt(frame, texel)
    const nearest = float(NOTHING).toVar()
    // The first map is the finest: what a ray of light meets in it counts.
    for (const map of maps) {
      If(nearest.equal(NOTHING), () => {
        seekOccluder(map, offset, storage, position => {
          nearest.assign(position)
        })
      })
    }
    return vec4(nearest.div(distance).clamp(-MOST_COTANGENT, MOST_COTANGENT), 0, 0, 0)
  })()
}

/**
 * Looks for the first occluder on a ray of light in a map, if the map has the ray.
 *
 * @param then - Takes the position along the ray, towards the light [m].
 */
function seekOccluder(
  { depth, size, matrix, bounds, metersPerDepth }: ShadowMapNodes,
  offset: Vec3,
  storage: DepthStorage,
  then: (position: Float) => void
): void {
  const place = (matrix as unknown as { mul(v: Vec4): Vec4 }).mul(vec4(offset, 1)).toConst()
  const isInside = place.x
    .greaterThan(bounds.x)
    .and(place.y.greaterThan(bounds.y))
    .and(place.x.lessThan(bounds.z))
    .and(place.y.lessThan(bounds.w))
  If(isInside, () => {
    // Texture coordinates run down, as three's shadow nodes have it.
    const at = vec2(place.x, place.y.oneMinus()).toConst()
    const stored = storage.isCompared
      ? comparedDepth(depth, at, storage)
      : mixedDepth(depth, size, at, storage)
    const position = stored.sub(place.z).mul(metersPerDepth)
    then(isEmpty(stored, storage).select(NOTHING, position).toConst())
  })
}
