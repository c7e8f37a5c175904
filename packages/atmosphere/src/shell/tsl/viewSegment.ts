import { If, dot } from 'three/tsl'
import { offsetPoint } from '@welkin/geo'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import type { AirRay } from '../../skyVolume/tsl/skyVolume'
import type { Bool, Float, Mat3, Vec2, Vec3 } from '../../tsl-types'
import { screenRay } from '../../view/tsl/screenRay'
import type { AirSegment } from './shellMarch'

/** Camera and sun of a shell as shader nodes. The mapped space is that of its body. */
export interface ShellView {
  /** Height of the camera above the ground, which may be negative [m]. */
  height: Float
  /** Zenith at the camera, mapped space. */
  up: Vec3
  /** Direction to the sun, mapped space, unit length. */
  sunDirectionMapped: Vec3
  /** Displacements in view space [world units] to the mapped space [m]. */
  viewToMapped: Mat3
  /** Factors of linear sRGB on scattered light. */
  tint: Vec3
  /** Half the diagonal of a pixel: angle for a perspective camera [rad], length for an orthographic one [m]. */
  pixel: Vec2
}

/** Part of a fragment's view ray that is in the air of a shell. */
export interface ViewSegment extends AirSegment {
  /** Segment in terms of the camera. Its length is 0 if the ray misses the air. */
  fromCamera: AirRay
  /**
   * Point whose depth the shell is drawn with, in view space [world units]: the middle of the segment to
   * the ground or the lowest point; from outside no farther than the nearest ground in the pixel.
   */
  middleView: Vec3
  /** Distance from the ray's origin to the segment's start [m]. */
  entry: Float
}

/** Fraction of the camera's height below which the lowest point of a ray counts as close to the ground. */
const GRAZING_FRACTION = 0.1

/** Origin of a view ray. */
interface RayOrigin {
  /** Height above the ground, at least 1 [m]. */
  height: Float
  /** Planet's centre to the origin [m]. */
  radius: Float
  /** Zenith, mapped space. */
  up: Vec3
}

function rayOrigin(
  { bottomRadius }: AtmosphereUniforms,
  view: ShellView,
  originView: Vec3,
  isOrthographic: Bool
): RayOrigin {
  const height = view.height.toVar()
  const radius = bottomRadius.add(view.height).max(1).toVar()
  const up = view.up.toVar()
  If(isOrthographic, () => {
    const offset = view.viewToMapped.mul(originView).toConst() as Vec3
    const beside = offsetPoint(offset, view.up, view.height, bottomRadius)
    height.assign(beside.height)
    radius.assign(beside.radius)
    up.assign(beside.up)
  })
  return {
    height: height.max(1).toConst(),
    radius,
    up
  }
}

/** Chord of a view ray through the air, from its origin or where it enters the air. */
interface AirChord extends Omit<AirSegment, 'radiusCosSun' | 'cosViewLight'> {
  /** μ at the ray's origin. */
  cosView: Float
  /** √(1 − μ²), more exact than from μ. */
  sinView: Float
  /** The ray's point nearest to the planet's centre, over the origin's radius. */
  nearest: Vec3
  /** Distance of that point from the centre [m]. */
  impactRadius: Float
  /** The origin is above the air. */
  isOutside: Bool
  /** Distance from the origin to the start of the chord [m]. */
  entry: Float
  /** Distance from the nearest point to the end of the chord [m]. */
  halfChord: Float
}

/**
 * Chord of a view ray.
 *
 * From far away the ray starts anew at the top of the air, by its distance from the planet's centre, so
 * that nothing cancels: b = r |up − μ d|. Roots and divisions cost most: there is one for both ends.
 *
 * @param d - View direction, mapped space, unit length.
 */
function airChord(
  { bottomRadius, thickness }: AtmosphereUniforms,
  { height, radius, up }: RayOrigin,
  d: Vec3
): AirChord {
  const cosView = dot(up, d).clamp(-1, 1).toConst() as Float
  const nearest = up.sub(d.mul(cosView)).toConst() as Vec3
  const sinView = nearest.length().toConst() as Float
  const impactRadius = sinView.mul(radius).toConst() as Float
  const fromNearest = radius.mul(cosView).toConst() as Float

  const top = bottomRadius.add(thickness).toConst() as Float
  const isOutside = height.greaterThan(thickness).toConst() as Bool
  const toTop = top.sub(impactRadius).mul(top.add(impactRadius)).max(0).sqrt().toConst()
  const radiusCosView = isOutside.select(toTop.negate(), fromNearest).toConst() as Float
  const altitude = height.min(thickness).toConst() as Float
  // t² + 2 r μ t + product = 0 on the ground, + gap less at the top.
  const product = altitude.mul(bottomRadius.mul(2).add(altitude)).toConst()
  const gap = thickness.sub(altitude).mul(top.add(bottomRadius).add(altitude))
  const square = radiusCosView.mul(radiusCosView).toConst()
  const discriminant = square.sub(product).toConst()
  const descends = radiusCosView.lessThan(0)
  const hitsGround = discriminant.greaterThanEqual(0).and(descends).toConst() as Bool
  const root = hitsGround.select(discriminant, square.add(gap).max(0)).sqrt().toConst() as Float
  const end = root.sub(radiusCosView).max(1e-3).toConst()
  const misses = isOutside.and(impactRadius.greaterThanEqual(top).or(cosView.greaterThan(0)))
  const length = misses.select(0, hitsGround.select(product.div(end), end)).toConst() as Float
  const passesNearest = hitsGround.not().and(descends).toConst() as Bool
  const lowest = passesNearest.select(impactRadius.sub(bottomRadius).max(0), altitude)
  return {
    altitude,
    radius: isOutside.select(top, radius).toConst(),
    radiusCosView,
    lowestAltitude: hitsGround.select(0, lowest).toConst(),
    hitsGround,
    length,
    cosView,
    sinView,
    nearest,
    impactRadius,
    isOutside,
    entry: isOutside.select(fromNearest.negate().sub(toTop).max(0), 0).toConst(),
    halfChord: root
  }
}

/** Distance from a ray's origin to the point whose depth the shell is drawn with [m]. */
function middleDistance(
  { bottomRadius }: AtmosphereUniforms,
  { altitude, radiusCosView, lowestAltitude, hitsGround, length, ...chord }: AirChord,
  pixel: Vec2
): Float {
  const { impactRadius, isOutside, entry, halfChord } = chord
  const passesNearest = hitsGround.not().and(radiusCosView.lessThan(0))
  const isLow = lowestAltitude.lessThan(altitude.mul(GRAZING_FRACTION))
  const isGrazing = passesNearest.and(isOutside.or(isLow))
  const partLength = isGrazing.select(radiusCosView.negate().min(length), length).toConst() as Float
  const middle = entry.add(partLength.mul(0.5)).toConst() as Float
  // Corners of a pixel may show ground that is nearer by more than the air is thick.
  const pixelRadius = entry.add(partLength).mul(pixel.x).add(pixel.y)
  const corner = impactRadius.sub(pixelRadius).max(0).toConst() as Float
  const cornerChord = bottomRadius.sub(corner).mul(bottomRadius.add(corner)).max(0).sqrt()
  const nearer = cornerChord.sub(hitsGround.select(halfChord, 0)).max(0)
  return isOutside.select(middle.sub(nearer).max(0), middle)
}

/** Part of the fragment's view ray that is in the air. */
export function viewSegment(uniforms: AtmosphereUniforms, view: ShellView): ViewSegment {
  const { direction, origin, isOrthographic } = screenRay()
  const directionView = direction.toConst() as Vec3
  const mapped = view.viewToMapped.mul(directionView).toConst() as Vec3
  const perMeter = mapped.dot(mapped).inverseSqrt().toConst() as Float
  const d = mapped.mul(perMeter).toConst() as Vec3
  const start = rayOrigin(uniforms, view, origin, isOrthographic)
  const chord = airChord(uniforms, start, d)
  const { altitude, radius, radiusCosView, lowestAltitude, hitsGround, length } = chord
  const { cosView, sinView } = chord
  const cosViewLight = dot(d, view.sunDirectionMapped).clamp(-1, 1).toConst() as Float
  const nearestCosSun = dot(chord.nearest, view.sunDirectionMapped).mul(start.radius)
  const middle = middleDistance(uniforms, chord, view.pixel)
  return {
    altitude,
    radius,
    radiusCosView,
    radiusCosSun: nearestCosSun.add(radiusCosView.mul(cosViewLight)).toConst(),
    cosViewLight,
    lowestAltitude,
    hitsGround,
    length,
    fromCamera: { cosView, sinView, cosViewLight, hitsGround, length },
    entry: chord.entry,
    middleView: origin.add(directionView.mul(middle.mul(perMeter)))
  }
}
