import { atan, vec2 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { sampleLevel0, type Bool, type Float, type Vec2, type Vec3 } from '../../tsl-types'

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
  /** Number of columns; there are four times as many rows. */
  readonly columns: Float
}

/** A view ray in a {@link PolarFrame}. */
export interface PolarRay {
  /** sin θ, which turns a distance along the ray into ρ. */
  sinViewLight: Float
  /** θ, or π − θ where the ray goes away from the light: half floats are finest near nought [rad]. */
  angle: Float
  /** True if the ray goes towards the light. */
  isTowards: Bool
  /** Texture coordinate of a row near φ, in turns: its middle. */
  row: Float
}

/**
 * @param direction - View direction, of unit length.
 * @param cosViewLight - ν, direction against the source.
 * @param jitter - Place of samples in their steps, in (0, 1), which also says which of two rows is taken. Their angles must
 *   not be mixed: a shadow before the sky would be displaced by up to a row, the more the farther from the light.
 */
export function polarRay(
  { across, along, columns }: PolarFrame,
  direction: Vec3,
  cosViewLight: Float,
  jitter: Float
): PolarRay {
  const x = direction.dot(across).toConst()
  const y = direction.dot(along).toConst()
  // Not √(1 − ν²), which cancels near the source.
  const sinViewLight = x.mul(x).add(y.mul(y)).sqrt().max(1e-7).toConst() as Float
  const turns = atan(y, x).mul(1 / (2 * Math.PI))
  const rows = columns.mul(4).toConst() as Float
  return {
    sinViewLight,
    angle: atan(sinViewLight, cosViewLight.abs()).toConst(),
    isTowards: cosViewLight.greaterThan(0).toConst(),
    row: turns.mul(rows).sub(0.5).add(jitter.mul(3).fract()).floor().add(0.5).div(rows).toConst()
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
 * Texture coordinate of the rays of light at a distance from the camera's.
 *
 * @param distance - ρ ≥ 0 [m].
 */
export function columnAt(frame: PolarFrame, distance: Float): Float {
  const { evenDistance, logScale, logOffset, columns } = frame
  const position = distance.div(evenDistance).add(1).log().mul(logScale).add(logOffset).clamp()
  return position.mul(columns.sub(1)).add(0.5).div(columns)
}

/**
 * True where air on a view ray is dark: an occluder on its ray of light stands at a smaller angle from the light.
 *
 * @param map - θ of the first occluder, and π − θ, of rays of light [rad].
 * @param distance - Distance from the camera [m].
 */
export function isDark(
  map: TextureNode,
  frame: PolarFrame,
  { sinViewLight, angle, isTowards, row }: PolarRay,
  distance: Float
): Bool {
  const at = vec2(columnAt(frame, distance.mul(sinViewLight)), row)
  const occluder = sampleLevel0(map, at).toConst()
  return isTowards.select(angle.greaterThan(occluder.x), angle.lessThan(occluder.y))
}
