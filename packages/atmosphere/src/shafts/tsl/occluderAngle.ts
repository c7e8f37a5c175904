import type { DepthTexture, Matrix4, Vector2, Vector4 } from 'three'
import { Fn, If, atan, float, ivec2, mix, texture, textureLoad, uv, vec2, vec4 } from 'three/tsl'
import type { TextureNode, UniformNode } from 'three/webgpu'
import { loop, type Float, type Vec2, type Vec4 } from '../../tsl-types'
import { lightRayAt, type PolarFrame } from './polarMap'

/** A shadow map of a light as the shader that merges them sees it. */
export interface ShadowMapNodes {
  readonly depth: TextureNode & { value: DepthTexture }
  /** Size of the texture [texels]. */
  readonly size: UniformNode<'vec2', Vector2>
  /** Displacements from the eye in the mapped space [m] to the map's coordinates. */
  readonly matrix: UniformNode<'mat4', Matrix4>
  /** First coordinates that are the map's, and last: a part of the texture where maps share one. */
  readonly bounds: UniformNode<'vec4', Vector4>
  /** Distance towards the light per unit of stored depth [m]. */
  readonly metersPerDepth: UniformNode<'float', number>
}

/** How a renderer stores depths. */
export interface DepthStorage {
  /** Greater is nearer. */
  readonly isReversed: boolean
  /** Depths can be read only by comparing: WebGL, from textures made for that. */
  readonly isCompared: boolean
}

/** Comparisons that find a depth: to 2⁻¹⁶ of the map's range. */
const COMPARISONS = 16

/** Part of the map's range at its far end that is taken to be empty. */
const EMPTY = 3e-5

/** Depth by bisection, where a texture can only be compared with. */
function comparedDepth(depth: TextureNode, at: Vec2, { isReversed }: DepthStorage): Float {
  const low = float(0).toVar()
  const width = float(0.5).toVar()
  const compared = texture(depth.value, at) as unknown as { compare(to: Float): Vec4 }
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

/** Depth between the four texels next to a place: without, slopes in shadow at a flat angle cast shadows in steps. */
function mixedDepth(depth: TextureNode, size: Vec2, at: Vec2): Float {
  const place = at.mul(size).sub(0.5).toConst()
  const first = place.floor().toConst()
  const part = place.sub(first).toConst()
  const read = (x: number, y: number): Float => {
    const texel = first.add(vec2(x, y)).clamp(vec2(0), size.sub(1))
    return (textureLoad(depth, ivec2(texel)) as unknown as Vec4).r
  }
  const [upper, lower] = [0, 1].map(y => mix(read(0, y), read(1, y), part.x))
  return mix(upper, lower, part.y)
}

/**
 * A texel of the sun-polar shadow map: its ray of light through all shadow maps, of which the occluder nearest
 * to the light counts.
 *
 * @returns Angle of the occluder from the source of light less π/2; π/2 where there is none [rad].
 */
export function occluderAngle(
  frame: PolarFrame,
  maps: readonly ShadowMapNodes[],
  storage: DepthStorage
): Vec4 {
  return Fn(() => {
    const { offset, distance } = lightRayAt(frame, uv())
    const nearest = float(-1e30).toVar()
    for (const { depth, size, matrix, bounds, metersPerDepth } of maps) {
      const place = (matrix as unknown as { mul(v: Vec4): Vec4 }).mul(vec4(offset, 1)).toConst()
      const isInside = place.x
        .greaterThan(bounds.x)
        .and(place.y.greaterThan(bounds.y))
        .and(place.x.lessThan(bounds.z))
        .and(place.y.lessThan(bounds.w))
      If(isInside, () => {
        // Texture coordinates run down, as three's shadow nodes have it.
        const at = vec2(place.x, place.y.oneMinus()).toConst() as Vec2
        const stored = (
          storage.isCompared ? comparedDepth(depth, at, storage) : mixedDepth(depth, size, at)
        ).toConst() as Float
        const isOccluded = storage.isReversed
          ? stored.greaterThan(EMPTY)
          : stored.lessThan(1 - EMPTY)
        If(isOccluded, () => {
          nearest.assign(nearest.max(stored.sub(place.z).mul(metersPerDepth)))
        })
      })
    }
    return vec4(atan(nearest.negate(), distance))
  })()
}
