import type { Vector3 } from 'three'
import { Break, Fn, If, bool, int, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { UniformNode } from 'three/webgpu'
import type { CloudField } from '../../density/CloudField'
import {
  loop,
  type Bool,
  type Float,
  type Int,
  type Vec2,
  type Vec3,
  type Vec4
} from '../../tsl-types'
import { sampleLayerPair } from '../../density/tsl/sampler'
import type { CloudSample } from '../../density/tsl/sample'
import { forLayers, layerAt, type LayerNodes } from '../../density/tsl/layer'

/** What the shader of a cascade reads. Vectors are in the mapped space, from the camera [m]. */
export interface ShadowRayUniforms {
  /** Direction to the source of light. */
  readonly toLight: UniformNode<'vec3', Vector3>
  /** Middle of the cascade in its plane. */
  readonly origin: UniformNode<'vec3', Vector3>
  /** Edges of the cascade. */
  readonly across: UniformNode<'vec3', Vector3>
  readonly along: UniformNode<'vec3', Vector3>
  readonly halfWidth: UniformNode<'float', number>
  /** Texels along an edge. */
  readonly size: number
}

/** Samples of a ray through a layer. */
const STEPS = 32

/** Steps longer than this are cut in three to find where clouds begin [m]; how often, and on a ray. */
const SEARCH_FROM = 100
const CUTS = 2
const SEARCHES = 2

/** Rays end this far from a cascade's plane, in its half widths: under a low sun they are long. */
export const REACH = 1.2

/** Greatest optical depth: half floats hold a few times as much. */
const MOST = 15_000

/** How much finer than its texels a cascade sees the clouds. */
const SHARPNESS = 0.5

/** Where a ray crosses the sphere at an altitude, in multiples of its direction; equal if it does not. */
function crossings(
  field: CloudField,
  radial: Float,
  height: Float,
  altitude: Float
): { back: Float; front: Float } {
  const c = height.sub(altitude).mul(field.radius.mul(2).add(height).add(altitude))
  const root = radial.mul(radial).sub(c).max(0).sqrt().toConst()
  return {
    back: radial.negate().sub(root).toConst(),
    front: root.sub(radial).toConst()
  }
}

/** The stretch of a sun ray in a layer that is nearest to the ray's start, in metres from there. */
function stretch(
  field: CloudField,
  { baseAltitude, thickness }: LayerNodes,
  radial: Float,
  height: Float,
  reach: Float
): { front: Float; back: Float } {
  const top = crossings(field, radial, height, baseAltitude.add(thickness))
  const base = crossings(field, radial, height, baseAltitude)
  const meetsBase = base.front.greaterThan(base.back).toConst()
  // Through the shell down to its base, or by it; and beyond the base a second time.
  const firstBack = meetsBase.select(base.front, top.back).toConst() as Float
  const second = base.back.add(top.back).abs()
  const isSecond = meetsBase.and(second.lessThan(top.front.add(firstBack).abs())).toConst()
  return {
    front: isSecond.select(base.back, top.front).clamp(reach.negate(), reach).toConst(),
    back: isSecond.select(top.back, firstBack).clamp(reach.negate(), reach).toConst()
  }
}

/**
 * A texel of a cascade: what its sun ray meets on the stretch of it that is in the clouds and nearest to
 * the camera. Clouds are kept as one even stretch with the same optical depth, the same middle and the
 * same spread, by optical depth; layers count by its square: thin clouds far above thick ones do not blur
 * these.
 *
 * @returns Front towards the sun, against the cascade's plane, and half of its length, both in half widths
 *   and times the optical depth: texels are mixed by it; optical depths, of all and of layers that cast
 *   shadows.
 * @see Hillaire 2016, "Physically based sky, atmosphere and cloud rendering in Frostbite" §5.9.4
 */
export function shadowRay(field: CloudField, ray: ShadowRayUniforms): Vec4 {
  return Fn(() => {
    const { view } = field
    const along = ray.toLight
    const at = uv().sub(0.5) as unknown as Vec2
    const start = ray.origin.add(ray.across.mul(at.x)).add(ray.along.mul(at.y)).toConst() as Vec3
    const radius = field.radius.add(view.height).toConst()
    const rise = start.dot(view.up).mul(radius).mul(2).add(start.dot(start)).toConst()
    const radiusThere = radius.mul(radius).add(rise).max(1).sqrt()
    const height = view.height.add(rise.div(radiusThere.add(radius))).toConst() as Float
    const radial = view.up.dot(along).mul(radius).add(start.dot(along)).toConst() as Float
    const reach = ray.halfWidth.mul(REACH).toConst() as Float
    const footprint = ray.halfWidth.mul((2 * SHARPNESS) / ray.size)
    const distance = footprint.div(field.pixelAngle).toConst() as Float
    /** Means of 1, place on the ray, and its square, times the layers' weights. */
    const weighted = vec3(0).toVar() as Vec3
    /** Optical depths, of all and of layers that cast shadows. */
    const depths = vec2(0).toVar() as Vec2
    forLayers(field, index => {
      const layer = layerAt(field, index)
      const { front, back } = stretch(field, layer, radial, height, reach)
      const length = front.sub(back).max(0).div(STEPS).toConst() as Float
      If(length.greaterThan(0).and(layer.coverage.greaterThan(0)), () => {
        /** Sums of optical depth, times place, and its square. */
        const sums = vec3(0).toVar() as Vec3
        const add = (top: Float, extinction: Float): void => {
          const width = top.sub(back).clamp(0, length).toConst() as Float
          const middle = top.sub(width.mul(0.5)).toConst() as Float
          const square = middle.mul(middle).add(width.mul(width).div(12))
          sums.addAssign(vec3(1, middle, square).mul(extinction.mul(width)))
        }
        const place = front.toVar() as Float
        /** Clouds begin between these two, once `cuts` are done. */
        const clear = front.toVar() as Float
        const cloudy = front.toVar() as Float
        const cuts = int(0).toVar() as Int
        const searches = int(length.greaterThan(SEARCH_FROM).select(SEARCHES, 0)).toVar() as Int
        const wasClear = bool(true).toVar() as Bool
        loop('shadowPair', STEPS / 2 + SEARCHES * (CUTS + 2), () => {
          If(place.lessThanEqual(back), () => {
            Break()
          })
          const isCutting = cuts.greaterThan(0).toConst()
          const step = isCutting.select(clear.sub(cloudy).div(3), length).toConst() as Float
          const from = isCutting.select(clear.sub(step.mul(0.5)), place).toConst() as Float
          const found = vec2(0).toVar() as Vec2
          const sampleAt = (steps: number): CloudSample => {
            const offset = start.add(along.mul(from.sub(step.mul(steps)))).toConst() as Vec3
            return { offset, ...view.place(offset), distance }
          }
          const [middle, first, second] = [1, 0.5, 1.5].map(sampleAt)
          sampleLayerPair(field, layer, middle, [first, second], (extinction, i) => {
            found.addAssign(i === 0 ? vec2(extinction, 0) : vec2(0, extinction))
          })
          /** Of the two, the first in clouds, in steps; 2.5 if both are clear. */
          const entry = found.x.greaterThan(0).select(0.5, found.y.greaterThan(0).select(1.5, 2.5))
          const at = from.sub(step.mul(entry)).toConst() as Float
          If(isCutting, () => {
            cloudy.assign(at)
            clear.assign(at.add(step))
            cuts.subAssign(int(1))
            place.assign(at.add(step.mul(0.5)))
          })
            .ElseIf(wasClear.and(entry.lessThan(2)).and(searches.greaterThan(0)), () => {
              cloudy.assign(at)
              clear.assign(at.add(step))
              cuts.assign(int(CUTS))
              searches.subAssign(int(1))
              wasClear.assign(false)
            })
            .Else(() => {
              add(place, found.x)
              add(place.sub(length), found.y)
              wasClear.assign(found.y.equal(0))
              place.subAssign(length.mul(2))
            })
        })
        const depth = sums.x.toConst() as Float
        weighted.addAssign(sums.mul(depth))
        depths.addAssign(vec2(depth, depth.mul(layer.shadow)))
      })
    })
    const weight = weighted.x.max(1e-12).toConst()
    const mean = weighted.y.div(weight).toConst() as Float
    const variance = weighted.z.div(weight).sub(mean.mul(mean))
    // Of an even stretch, the deviation is its length over √12.
    const half = variance.max(1).mul(3).sqrt().div(ray.halfWidth).toConst()
    const front = mean.div(ray.halfWidth).add(half)
    const depth = depths.min(MOST).toConst() as Vec2
    return vec4(vec2(front, half).mul(depth.x), depth)
  })()
}
