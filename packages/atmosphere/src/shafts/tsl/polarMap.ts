import { atan, mix, vec2 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { loadTexel, type Bool, type Float, type Vec2, type Vec3 } from '../../tsl-types'

/** Factor on noise for numbers that are not alike: 4√5. */
const NOISE_STRIDE = 8.944

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
  /** Distance ρ₀ up to which columns are even; beyond, they grow with ρ [m]. */
  readonly evenDistance: Float
  /** Factor and summand that turn ln(1 + ρ/ρ₀) into a position among columns, in [0, 1] from first to last. */
  readonly logScale: Float
  readonly logOffset: Float
  /** Number of columns, and of rows. */
  readonly columns: Float
  readonly rows: Float
}

/** A view ray in a {@link PolarFrame}. */
export interface PolarRay {
  /** sin θ, which turns a distance along the ray into ρ. */
  sinViewLight: Float
  /** θ, or π − θ where the ray goes away from the light: half floats are finest near nought [rad]. */
  angle: Float
  /** True if the ray goes towards the light. */
  isTowards: Bool
  /** The two rows whose middles φ is between, and its place between them. */
  rows: readonly [Float, Float]
  betweenRows: Float
}

/**
 * @param direction - View direction, of unit length.
 * @param cosViewLight - ν, direction against the source.
 */
export function polarRay(
  { across, along, rows }: PolarFrame,
  direction: Vec3,
  cosViewLight: Float
): PolarRay {
  const x = direction.dot(across).toConst()
  const y = direction.dot(along).toConst()
  // Not √(1 − ν²), which cancels near the source.
  const sinViewLight = x.mul(x).add(y.mul(y)).sqrt().max(1e-7).toConst() as Float
  const turns = atan(y, x).mul(1 / (2 * Math.PI))
  const place = turns.add(1).mul(rows).sub(0.5).toConst() as Float
  const first = place.floor().toConst() as Float
  return {
    sinViewLight,
    angle: atan(sinViewLight, cosViewLight.abs()).toConst(),
    isTowards: cosViewLight.greaterThan(0).toConst(),
    rows: [first.mod(rows).toConst(), first.add(1).mod(rows).toConst()],
    betweenRows: place.sub(first).toConst()
  }
}

/** A texel's ray of light: the displacement from the camera of its point nearest to the camera, and ρ [m]. */
export function lightRayAt(frame: PolarFrame, uv: Vec2): { offset: Vec3; distance: Float } {
  const { across, along, evenDistance, logScale, logOffset, columns } = frame
  const position = uv.x.mul(columns).sub(0.5).div(columns.sub(1))
  const grown = position.sub(logOffset).div(logScale).exp().sub(1)
  const distance = grown.max(1e-3).mul(evenDistance).toConst() as Float
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
  const { evenDistance, logScale, logOffset, columns } = frame
  const position = distance.div(evenDistance).add(1).log().mul(logScale).add(logOffset).clamp()
  return position.mul(columns.sub(1))
}

/**
 * Dark part of the air at a place of a view ray, in [0, 1]: where an occluder on a ray of light stands at a smaller angle from
 * the light, between the four nearest rays. Each is compared: angles must not be mixed, or a shadow before the sky would be
 * displaced by up to a texel, the more the farther from the light one looks.
 *
 * @param map - θ of the first occluder, and π − θ, of rays of light [rad].
 * @param distance - Distance from the camera [m].
 */
export function darkPart(
  map: TextureNode,
  frame: PolarFrame,
  ray: PolarRay,
  distance: Float
): Float {
  const { sinViewLight, rows, betweenRows } = ray
  const column = columnAt(frame, distance.mul(sinViewLight)).toConst() as Float
  const first = column.floor().toConst() as Float
  const columns = [first, first.add(1).min(frame.columns.sub(1)).toConst() as Float]
  const dark = columns.map(x => {
    const [here, next] = rows.map(y => isDark(map, ray, x, y))
    return mix(here, next, betweenRows)
  })
  return mix(dark[0], dark[1], column.sub(first)).toConst()
}

/**
 * As {@link darkPart} in the mean, from one of the four rays: for what is read often, or has a history.
 *
 * @param noise - In [0, 1).
 */
export function ditheredDark(
  map: TextureNode,
  frame: PolarFrame,
  ray: PolarRay,
  distance: Float,
  noise: Float
): Float {
  const column = columnAt(frame, distance.mul(ray.sinViewLight))
  // Noise of columns is apart from that of rows.
  const x = column.add(noise.mul(NOISE_STRIDE).fract()).floor().min(frame.columns.sub(1))
  const y = ray.betweenRows.greaterThan(noise).select(ray.rows[1], ray.rows[0])
  return isDark(map, ray, x.toConst(), y.toConst()).toConst()
}

/** 1 if a view ray's place is dark by a ray of light, else 0. */
function isDark(map: TextureNode, ray: PolarRay, x: Float, y: Float): Float {
  const { angle, isTowards } = ray
  const { x: occluder, y: behind } = loadTexel(map, vec2(x, y)).toConst()
  return isTowards.select(angle.greaterThan(occluder), angle.lessThan(behind)).select(1, 0)
}
