import {
  Fn,
  If,
  cameraFar,
  cameraNear,
  cameraProjectionMatrix,
  dot,
  select,
  vec3,
  vec4,
  viewZToLogarithmicDepth
} from 'three/tsl'
import type { Node, NodeBuilder, Renderer } from 'three/webgpu'
import { WebGLCoordinateSystem } from 'three'
import type { Bool, Float, Mat3, Vec3, Vec4 } from '../tsl-types'
import { distanceToGround, distanceToTop, groundDiscriminant } from './boundary'
import { linearSRGB, transmittanceRGB } from './color'
import type { Air, Ray } from './scattering'
import { screenRay } from './screenRay'
import type { Shell } from './shellMarch'
import type { Sight } from './skyVolume'

/** Where a shell is seen from: the mapped space of its body, as shader nodes. */
export interface ShellPlace {
  /** Of the camera above the ground, which may be negative [m]. */
  height: Float
  /** Zenith at the camera. */
  up: Vec3
  /** Direction to the sun, unit length. */
  sunDirection: Vec3
  /** Displacements in view space [world units] to the mapped space [m]. */
  viewToMapped: Mat3
  /** Factors for the linear-sRGB components of scattered light. */
  tint: Vec3
}

/** A fragment's way through the air of a shell. */
export interface Way {
  /** From the camera, or from where it enters the air. */
  ray: Ray
  /** The same from the camera. Its length is 0 if it misses the air. */
  sight: Sight
  /** Half of the way, in view space [world units]. */
  middleView: Vec3
}

/**
 * The way through the air in the direction of a fragment.
 *
 * From far away the ray starts anew at the top of the air, by its distance from the planet's centre, so
 * that nothing cancels: b = r |up − μ d|.
 */
function wayThrough({ uniforms }: Air, place: ShellPlace): Way {
  const { bottomRadius, thickness } = uniforms
  const { direction, origin } = screenRay()
  const directionView = direction.normalize().toConst() as Vec3
  const originView = origin.toConst() as Vec3
  const mapped = place.viewToMapped.mul(directionView).toConst() as Vec3
  const metersPerUnit = mapped.length().toConst() as Float
  const d = mapped.div(metersPerUnit).toConst() as Vec3
  const cosViewSun = dot(d, place.sunDirection).clamp(-1, 1).toConst() as Float

  // h' = h + (2 r o·up + o²)/(r' + r) for the point beside an orthographic camera.
  const offset = place.viewToMapped.mul(originView).toConst() as Vec3
  const eyeRadius = bottomRadius.add(place.height).toConst()
  const rise = offset.dot(place.up).mul(eyeRadius).mul(2).add(offset.dot(offset)).toConst()
  const radius = eyeRadius.mul(eyeRadius).add(rise).max(1).sqrt().toConst()
  const height = place.height
    .add(rise.div(radius.add(eyeRadius)))
    .max(1)
    .toConst()
  const up = place.up.mul(eyeRadius).add(offset).div(radius).toConst() as Vec3
  const cosView = dot(up, d).clamp(-1, 1).toConst() as Float

  const top = bottomRadius.add(thickness).toConst()
  const isOutside = height.greaterThan(thickness).toConst() as Bool
  const nearest = up.sub(d.mul(cosView)).mul(radius).toConst() as Vec3
  const miss = nearest.length().toConst()
  const half = top.sub(miss).mul(top.add(miss)).max(0).sqrt().toConst()
  const toNearest = radius.mul(cosView).negate().toConst()
  const entry = isOutside.select(toNearest.sub(half).max(0), 0).toConst() as Float
  const misses = isOutside.and(miss.greaterThanEqual(top).or(cosView.greaterThan(0)))
  const sunAtEntry = dot(nearest.sub(d.mul(half)), place.sunDirection).div(top)
  const ray: Ray = {
    altitude: isOutside.select(thickness, height).toConst(),
    cosView: isOutside.select(half.div(top).negate(), cosView).clamp(-1, 1).toConst(),
    cosSun: isOutside.select(sunAtEntry, dot(up, place.sunDirection)).clamp(-1, 1).toConst(),
    cosViewSun
  }
  const discriminant = groundDiscriminant(ray.altitude, ray.cosView, bottomRadius).toConst()
  const hitsGround = discriminant.greaterThanEqual(0).and(ray.cosView.lessThan(0)).toConst() as Bool
  const length = hitsGround.select(
    distanceToGround(ray.altitude, ray.cosView, discriminant as Float, bottomRadius),
    distanceToTop(ray.altitude, ray.cosView, bottomRadius, thickness)
  )
  const inAir = misses.select(0, length).toConst() as Float
  const middle = entry.add(inAir.mul(0.5)).div(metersPerUnit)
  const sinView = miss.div(radius).toConst() as Float
  return {
    ray,
    sight: { cosView, sinView, cosViewSun, hitsGround, length: inAir },
    middleView: originView.add(directionView.mul(middle))
  }
}

/** Depth of a point in view space as the renderer writes it, within what it can write. */
function fragmentDepth(positionView: Vec3, builder: NodeBuilder): Float {
  const renderer = builder.renderer as Renderer & {
    logarithmicDepthBuffer: boolean
    reversedDepthBuffer: boolean
  }
  const clip = cameraProjectionMatrix.mul(vec4(positionView, 1)).toConst()
  const normalized = clip.z.div(clip.w)
  const isSigned =
    renderer.coordinateSystem === WebGLCoordinateSystem && !renderer.reversedDepthBuffer
  const projected = isSigned ? normalized.mul(0.5).add(0.5) : normalized
  const depth = renderer.logarithmicDepthBuffer
    ? select(
        clip.w.equal(1),
        projected,
        viewZToLogarithmicDepth(positionView.z.min(cameraNear.negate()), cameraNear, cameraFar)
      )
    : projected
  return depth.clamp(0, 1)
}

/** Part of luminance in the components of linear sRGB. */
const LUMINANCE = /*#__PURE__*/ vec3(0.2126, 0.7152, 0.0722)

/**
 * Light of a shell's air, and how much of what is behind it that hides: premultiplied colour.
 *
 * @param lightOf - What the air along a way gives and takes.
 */
export function shellColor(air: Air, place: ShellPlace, lightOf: (way: Way) => Shell): Vec4 {
  return Fn(() => {
    const way = wayThrough(air, place)
    const color = vec4(0).toVar()
    If(way.sight.length.greaterThan(0), () => {
      const { radiance, depth } = lightOf(way)
      const through = transmittanceRGB(air.uniforms, depth.negate().exp())
      const light = linearSRGB(air.uniforms, radiance).mul(place.tint)
      color.assign(vec4(light, dot(through, LUMINANCE).oneMinus().clamp()))
    })
    return color
  })()
}

/** Depth at which a shell is compared with what was drawn: half of the way through the air. */
export function shellDepth(air: Air, place: ShellPlace): Float {
  const depth = (_inputs: unknown, builder: NodeBuilder): Node =>
    fragmentDepth(wayThrough(air, place).middleView, builder)
  return (Fn as unknown as (body: typeof depth) => () => Float)(depth)()
}
