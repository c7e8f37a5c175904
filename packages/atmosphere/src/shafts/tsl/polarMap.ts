import { atan, mix, vec2 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { gatherRed, type Float, type Vec2, type Vec3, type Vec4 } from '../../tsl-types'

/** Columns and rows by which {@link softDark} reads beside a place, about as far: with one alone, shadows of hills on clouds far away have edges in steps (*Fog from above*). */
const BESIDE = [
  [-0.6, 1],
  [-0.2, -3],
  [0.2, 3],
  [0.6, -1]
] as const

/** Greatest cotangent of an angle that the map keeps, and the least of a view ray, which is greater than that of no occluder: half floats hold a little more. */
export const MOST_COTANGENT = 6e4
const LEAST_SEEN = -5e4

/**
 * Polar coordinates about the camera with the source of light as pole: θ from the source, φ around it, ρ the
 * distance from the line between both. A view ray has one θ and one φ, a ray of light one φ and one ρ. All in
 * the mapped space.
 */
export interface PolarFrame {
  /** Direction of φ = 0, at right angles to the light's; unit length. */
  readonly across: Vec3
  /** Direction of φ = π/2. */
  readonly along: Vec3
  /** Reciprocal of the distance ρ₀ up to which columns are even; beyond, they grow with ρ [1/m]. */
  readonly perMeter: Float
  /** Factor and summand that turn log₂(1 + ρ/ρ₀) into a place among columns. */
  readonly logScale: Float
  readonly logOffset: Float
  /** Number of columns, and of rows; and their reciprocals. */
  readonly size: Vec2
  readonly texelSize: Vec2
}

/** A view ray in a {@link PolarFrame}. */
export interface PolarRay {
  /** sin θ, which turns a distance along the ray into ρ. */
  sinViewLight: Float
  /** cot θ: occluders of a greater one are nearer to the light. */
  cotangent: Float
  /** Place of φ among rows, of which there are more beyond the last: whole numbers are middles of rows. */
  row: Float
}

/**
 * @param direction - View direction, of unit length.
 * @param cosViewLight - ν, direction against the source.
 */
export function polarRay(
  { across, along, size }: PolarFrame,
  direction: Vec3,
  cosViewLight: Float
): PolarRay {
  const x = direction.dot(across).toConst()
  const y = direction.dot(along).toConst()
  // Not √(1 − ν²), which cancels near the source.
  const sinViewLight = x.mul(x).add(y.mul(y)).sqrt().max(1e-7).toConst() as Float
  const turns = atan(y, x).mul(1 / (2 * Math.PI))
  return {
    sinViewLight,
    cotangent: cosViewLight.div(sinViewLight).max(LEAST_SEEN).toConst(),
    row: turns.add(1).mul(size.y).sub(0.5).toConst()
  }
}

/** A texel's ray of light: the displacement from the camera of its point nearest to the camera, and ρ [m]. */
export function lightRayAt(frame: PolarFrame, uv: Vec2): { offset: Vec3; distance: Float } {
  const { across, along, perMeter, logScale, logOffset, size } = frame
  const grown = uv.x.mul(size.x).sub(0.5).sub(logOffset).div(logScale).exp2().sub(1)
  const distance = grown.max(1e-3).div(perMeter).toConst() as Float
  const azimuth = uv.y.mul(2 * Math.PI).toConst()
  const offset = across.mul(azimuth.cos()).add(along.mul(azimuth.sin())).mul(distance)
  return { offset: offset.toConst(), distance }
}

/**
 * Place among columns of the rays of light at a distance from the camera's: whole numbers are middles of columns.
 *
 * @param distance - ρ ≥ 0 [m].
 */
export function columnAt(frame: PolarFrame, distance: Float): Float {
  const { perMeter, logScale, logOffset, size } = frame
  const place = distance.mul(perMeter).add(1).log2().mul(logScale).add(logOffset)
  return place.clamp(0, size.x.sub(1))
}

/**
 * Dark part of the air at a place of a view ray, in [0, 1]: where an occluder on a ray of light stands at a smaller angle from
 * the light, between the four nearest rays. Each is compared: angles must not be mixed, or a shadow before the sky would be
 * displaced by up to a texel, the more the farther from the light one looks.
 *
 * @param map - cot θ of the first occluder of rays of light.
 * @param distance - Distance from the camera [m].
 */
export function darkPart(
  map: TextureNode,
  frame: PolarFrame,
  ray: PolarRay,
  distance: Float
): Float {
  return darkAt(map, frame, ray, placeOf(frame, ray, distance))
}

const placeOf = (frame: PolarFrame, { sinViewLight, row }: PolarRay, distance: Float): Vec2 =>
  vec2(columnAt(frame, distance.mul(sinViewLight)), row).toConst()

/** Mean of what {@link gatherRed} has read, by the place between the texels, in [0, 1]². */
export const bilinear = ({ x, y, z, w }: Vec4, part: Vec2): Float =>
  mix(mix(w, z, part.x), mix(x, y, part.x), part.y).toConst()

/** Dark part of the air between the four rays of light about a place among columns and rows. */
function darkAt(map: TextureNode, frame: PolarFrame, { cotangent }: PolarRay, at: Vec2): Float {
  const place = at.toConst()
  const first = place.floor().toConst() as Vec2
  // Not a step: loops about it have a variable of that name.
  const nearer = gatherRed(map, first.add(1).mul(frame.texelSize)).sub(cotangent)
  const four = nearer.sign().max(0).toConst()
  return bilinear(four, place.sub(first).toConst())
}

/** As {@link darkPart}, of rays of light about, too: edges of shadows are soft. */
export function softDark(
  map: TextureNode,
  frame: PolarFrame,
  ray: PolarRay,
  distance: Float
): Float {
  const place = placeOf(frame, ray, distance)
  const parts = BESIDE.map(([column, row]) =>
    darkAt(map, frame, ray, place.add(vec2(column, row)) as Vec2)
  )
  return parts.reduce((sum, part) => sum.add(part)).div(BESIDE.length)
}
