import type { Vector3 } from 'three'
import { float, Fn, If, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { UniformNode } from 'three/webgpu'
import type { CloudField } from '../../density/CloudField'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'
import type { CloudSample } from '../../density/tsl/sample'
import { forLayers, layerAt, type LayerNodes } from '../../density/tsl/layer'
import { fallMoments, type ShadingFall } from './fallDepth'
import { layerSegment, type RadialRay } from './layerSegment'
import { NO_CLOUDS, segmentMoments, STEPS, type StretchMoments } from './segmentMoments'

/** Uniforms of the shader that draws a cascade. Vectors are in the mapped space, from the camera [m]. */
export interface ShadowRayUniforms {
  /** Direction to the light, unit length. */
  readonly toLight: UniformNode<'vec3', Vector3>
  /** Middle of the cascade in its plane. */
  readonly origin: UniformNode<'vec3', Vector3>
  /** Edges of the cascade, as long as they are. */
  readonly across: UniformNode<'vec3', Vector3>
  readonly along: UniformNode<'vec3', Vector3>
  /** Half of an edge's length [m]. */
  readonly halfWidth: UniformNode<'float', number>
  /** Texels along an edge. */
  readonly size: number
}

/**
 * Distance from a cascade's plane at which rays end [half widths]: under a low sun they are long. Smaller:
 * clouds far off cast no shadow at dusk (*Shadows*).
 */
export const MAXIMUM_DISTANCE = 1.2

/** Width of a cascade over that of the next narrower one. */
export const CASCADE_RATIO = 4

/** Greatest optical depth: half floats hold a few times as much. */
const MOST = 15_000

/** Footprint of samples over a cascade's texel [–]. Greater: soft shadows; smaller: grain (*Shadows*). */
const SHARPNESS = 0.5

/** Footprint of samples over a step through a layer [–]. Smaller: rings on tall clouds (*Storm*). */
const BLUR = 0.35

/** Footprint of samples over the path through precipitation [–]. Greater: soft shadows of shafts (*Rain and snow*). */
const FALL_BLUR = 0.03

/** A ray of light through a texel. */
interface LightRay extends RadialRay {
  /** Crossing with the cascade's plane, from the camera in the mapped space [m]. */
  readonly start: Vec3
  /** Distance to which clouds are looked for, to either side of the plane [m]. */
  readonly maximumDistance: Float
  /** Distance from the camera that has the right level of detail [m]. */
  readonly distance: Float
}

/** The ray of the texel that is drawn. */
function lightRay({ view, radius, pixelAngle }: CloudField, ray: ShadowRayUniforms): LightRay {
  const at = uv().sub(0.5) as unknown as Vec2
  const start = ray.origin.add(ray.across.mul(at.x)).add(ray.along.mul(at.y)).toConst() as Vec3
  const radiusHere = radius.add(view.height).toConst()
  const rise = start.dot(view.up).mul(radiusHere).mul(2).add(start.dot(start)).toConst()
  const radiusThere = radiusHere.mul(radiusHere).add(rise).max(1).sqrt()
  const height = view.height.add(rise.div(radiusThere.add(radiusHere))).toConst() as Float
  const radial = view.up
    .dot(ray.toLight)
    .mul(radiusHere)
    .add(start.dot(ray.toLight))
    .toConst() as Float
  const maximumDistance = ray.halfWidth.mul(MAXIMUM_DISTANCE).toConst() as Float
  const footprint = ray.halfWidth.mul((2 * SHARPNESS) / ray.size)
  const distance = footprint.div(pixelAngle).toConst() as Float
  return { start, radial, height, maximumDistance, distance }
}

/**
 * A texel of a cascade: what its ray of light meets on the stretch of it that is in the clouds and nearest
 * to the camera. Clouds are kept as one even stretch with the same optical depth, the same middle and the
 * same spread, by optical depth; layers count by its square: thin clouds far above thick ones do not blur
 * these.
 *
 * @param falling - Rain and snow below the clouds, which count in the same way.
 * @returns Front towards the light, against the cascade's plane, and half of its length, both in half
 *   widths and times the optical depth: texels are mixed by it; optical depths, of all and of layers that
 *   cast shadows.
 * @see Hillaire 2016, "Physically based sky, atmosphere and cloud rendering in Frostbite" §5.9.4
 */
export function shadowRay(field: CloudField, ray: ShadowRayUniforms, falling?: ShadingFall): Vec4 {
  return Fn(() => {
    const texel = lightRay(field, ray)
    const sampleAt = (at: Float, distance: Float): CloudSample => {
      const offset = texel.start.add(ray.toLight.mul(at)).toConst() as Vec3
      return { offset, ...field.view.localCoordinates(offset), distance, billowFootprints: 1 }
    }
    /** Means of 1, place on the ray, and its square, times the layers' weights. */
    const weighted = vec3(0).toVar() as Vec3
    /** Optical depths, of all and of layers that cast shadows. */
    const depths = vec2(0).toVar() as Vec2
    /** Distance at which the first cloud begins, from the light. */
    const first = float(NO_CLOUDS).toVar()
    const add = ({ sums, entry }: StretchMoments, layer: LayerNodes): void => {
      first.assign(first.max(entry))
      const depth = sums.x.toConst() as Float
      weighted.addAssign(sums.mul(depth))
      depths.addAssign(vec2(depth, depth.mul(layer.shadow)))
    }
    /** Distance that samples stand for whose footprint is a part of a length. */
    const blurred = (length: Float, blur: number): Float =>
      texel.distance.max(length.mul(blur).div(field.pixelAngle)).toConst()
    forLayers(field, index => {
      const layer = layerAt(field, index)
      const segment = layerSegment(field, layer, texel, texel.maximumDistance)
      const length = segment.front.sub(segment.back).max(0).div(STEPS).toConst() as Float
      If(length.greaterThan(0).and(layer.coverage.greaterThan(0)), () => {
        // What is shorter than steps would show as rings.
        const distance = blurred(length, BLUR)
        add(
          segmentMoments(field, layer, segment, length, at => sampleAt(at, distance)),
          layer
        )
      })
      if (falling === undefined) return
      const below = { baseAltitude: float(0), thickness: falling.ceiling }
      const fall = layerSegment(field, below, texel, texel.maximumDistance)
      const way = fall.front.sub(fall.back).toConst() as Float
      If(way.greaterThan(0).and(falling.ceiling.greaterThan(0)), () => {
        const distance = blurred(way, FALL_BLUR)
        add(
          fallMoments(field, falling, layer, fall, at => sampleAt(at, distance)),
          layer
        )
      })
    })
    return evenStretch(weighted, depths, first, ray.halfWidth)
  })()
}

/**
 * The even stretch of cloud that has the same moments: see `shadowRay`. It begins no nearer to the light than the first
 * cloud: two storms behind each other would darken the air before them.
 */
function evenStretch(weighted: Vec3, depths: Vec2, first: Float, halfWidth: Float): Vec4 {
  const weight = weighted.x.max(1e-12).toConst()
  const mean = weighted.y.div(weight).toConst() as Float
  const variance = weighted.z.div(weight).sub(mean.mul(mean))
  // An even stretch has a deviation of its length over √12.
  const most = first.sub(mean).max(1)
  const half = variance.max(1).mul(3).sqrt().min(most).div(halfWidth).toConst()
  const front = mean.div(halfWidth).add(half)
  const depth = depths.min(MOST).toConst() as Vec2
  return vec4(vec2(front, half).mul(depth.x), depth)
}
