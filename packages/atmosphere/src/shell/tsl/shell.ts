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
import { offsetPoint } from '@welkin/geo'
import type { Bool, Float, Mat3, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { linearSRGB, transmittanceRGB } from '../../air/tsl/color'
import type { Air } from '../../scattering/tsl/scattering'
import { screenRay } from '../../view/tsl/screenRay'
import type { Shell, ShellRay } from './shellMarch'
import type { Sight } from '../../skyVolume/tsl/skyVolume'

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
  /** Half the diagonal of a pixel: over the distance, and for an orthographic camera [m]. */
  pixel: Vec2
}

/** Part of the eye's height up to which rays that turn pass close to the ground. */
const BESIDE = 0.1

/** A fragment's way through the air of a shell. */
export interface Way extends ShellRay {
  /** The same from the camera. Its length is 0 if it misses the air. */
  sight: Sight
  /**
   * Half of the way to the ground, the lowest point or out of the air, from outside no farther than the
   * nearest ground in the pixel; in view space [world units].
   */
  middleView: Vec3
}

/** Height above the ground, distance from the centre, and zenith of where a ray starts. */
function rayStart({ uniforms }: Air, place: ShellPlace, origin: Vec3, isOrthographic: Bool) {
  const height = place.height.toVar()
  const radius = uniforms.bottomRadius.add(place.height).max(1).toVar()
  const up = place.up.toVar()
  If(isOrthographic, () => {
    const offset = place.viewToMapped.mul(origin).toConst() as Vec3
    const beside = offsetPoint(offset, place.up, place.height, uniforms.bottomRadius)
    height.assign(beside.height)
    radius.assign(beside.radius)
    up.assign(beside.up)
  })
  return {
    height: height.max(1).toConst() as Float,
    radius: radius as unknown as Float,
    up: up as unknown as Vec3
  }
}

/**
 * The way through the air in the direction of a fragment.
 *
 * From far away the ray starts anew at the top of the air, by its distance from the planet's centre, so
 * that nothing cancels: b = r |up − μ d|. Roots and divisions cost most: there is one for both ends.
 */
function wayThrough(air: Air, place: ShellPlace): Way {
  const { bottomRadius, thickness } = air.uniforms
  const { direction, origin, isOrthographic } = screenRay()
  const directionView = direction.toConst() as Vec3
  const mapped = place.viewToMapped.mul(directionView).toConst() as Vec3
  const perMeter = mapped.dot(mapped).inverseSqrt().toConst() as Float
  const d = mapped.mul(perMeter).toConst() as Vec3
  const { height, radius, up } = rayStart(air, place, origin, isOrthographic)

  const cosViewSun = dot(d, place.sunDirection).clamp(-1, 1).toConst() as Float
  const cosView = dot(up, d).clamp(-1, 1).toConst() as Float
  const nearest = up.sub(d.mul(cosView)).toConst() as Vec3
  const sinView = nearest.length().toConst() as Float
  const miss = sinView.mul(radius).toConst() as Float
  const fromNearest = radius.mul(cosView).toConst() as Float

  const top = bottomRadius.add(thickness).toConst() as Float
  const isOutside = height.greaterThan(thickness).toConst() as Bool
  const half = top.sub(miss).mul(top.add(miss)).max(0).sqrt().toConst()
  const radial = isOutside.select(half.negate(), fromNearest).toConst() as Float
  const altitude = height.min(thickness).toConst() as Float
  // t² + 2 radial t + product = 0 on the ground, + gap less at the top.
  const product = altitude.mul(bottomRadius.mul(2).add(altitude)).toConst()
  const gap = thickness.sub(altitude).mul(top.add(bottomRadius).add(altitude))
  const square = radial.mul(radial).toConst()
  const discriminant = square.sub(product).toConst()
  const hitsGround = discriminant.greaterThanEqual(0).and(radial.lessThan(0)).toConst() as Bool
  const root = hitsGround.select(discriminant, square.add(gap).max(0)).sqrt().toConst()
  const end = root.sub(radial).max(1e-3).toConst()
  const misses = isOutside.and(miss.greaterThanEqual(top).or(cosView.greaterThan(0)))
  const inAir = hitsGround.select(product.div(end), end)
  const length = misses.select(0, inAir).toConst() as Float
  const entry = isOutside.select(fromNearest.negate().sub(half).max(0), 0).toConst() as Float
  const turns = hitsGround.not().and(radial.lessThan(0)).toConst() as Bool
  const lowest = turns.select(miss.sub(bottomRadius).max(0), altitude).toConst() as Float
  const isBeside = turns.and(isOutside.or(lowest.lessThan(altitude.mul(BESIDE))))
  const reach = isBeside.select(radial.negate().min(length), length).toConst() as Float
  const halfway = entry.add(reach.mul(0.5)).toConst() as Float
  // Corners of a pixel may show ground that is nearer by more than the air is thick.
  const nearestInPixel = miss.sub(entry.add(reach).mul(place.pixel.x).add(place.pixel.y)).max(0)
  const corner = nearestInPixel.toConst() as Float
  const bulge = bottomRadius.sub(corner).mul(bottomRadius.add(corner)).max(0).sqrt()
  const nearer = bulge.sub(hitsGround.select(root, 0)).max(0)
  const compared = isOutside.select(halfway.sub(nearer).max(0), halfway)
  return {
    altitude,
    radius: isOutside.select(top, radius).toConst(),
    radial,
    sunward: dot(nearest, place.sunDirection).mul(radius).add(radial.mul(cosViewSun)).toConst(),
    cosViewSun,
    lowest: hitsGround.select(0, lowest).toConst(),
    hitsGround,
    length,
    sight: { cosView, sinView, cosViewSun, hitsGround, length },
    middleView: origin.add(directionView.mul(compared.mul(perMeter)))
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

/** A `Fn` that is told what builds it. */
const withBuilder = Fn as unknown as (
  body: (inputs: unknown, builder: NodeBuilder) => Node
) => () => Node

/**
 * What the fragments of a shell write.
 *
 * @param lightOf - What the air along a way gives and takes.
 * @returns Premultiplied colour: light of the air, and how much of what is behind it that hides; and
 *   the depth at which a shell is compared with what was drawn: half of the way.
 */
export function shellFragment(
  air: Air,
  place: ShellPlace,
  lightOf: (way: Way) => Shell
): { color: Vec4; depth: Float } {
  // three writes the depth first, if it does, in the same function.
  const ways = new WeakMap<NodeBuilder, Way>()
  const wayOf = (builder: NodeBuilder): Way => {
    const way = ways.get(builder) ?? wayThrough(air, place)
    ways.set(builder, way)
    return way
  }
  const color = withBuilder((_, builder) => {
    const way = wayOf(builder)
    const output = vec4(0).toVar()
    If(way.length.greaterThan(0), () => {
      const { radiance, depth } = lightOf(way)
      const through = transmittanceRGB(air.uniforms, depth.negate().exp())
      const light = linearSRGB(air.uniforms, radiance).mul(place.tint)
      output.assign(vec4(light, dot(through, LUMINANCE).oneMinus().clamp()))
    })
    return output
  })
  const depth = withBuilder((_, builder) => fragmentDepth(wayOf(builder).middleView, builder))
  return { color: color() as Vec4, depth: depth() as Float }
}
