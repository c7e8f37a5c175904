import type { Texture } from 'three'
import { atan, float, step, texture, vec2, vec4 } from 'three/tsl'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { ofKinds, type GroundKind, type OfKinds } from '../maps/groundKinds'

/** A mask: see `GroundMask`. */
export interface MaskInShader {
  readonly texture: Texture
  readonly materials: readonly (GroundKind | null)[]
  readonly uniforms: Readonly<
    Record<'east' | 'meridian' | 'north' | 'reference' | 'scale' | 'middle', Vec3>
  >
}

/** Factor by which stones move the edges of what is painted. */
const FRAYED = 2

/**
 * Place on a mask, from its south-western corner: 0 to 1 across it.
 *
 * Longitude and latitude count from the middle, by components that the CPU has found of the reference: float32 keeps millimetres near by. With
 * ρ the distance to the axis, m its component along the middle meridian and e that to the east, ρ = m + e² / (ρ + m).
 *
 * @param offset - Reference to a place on the ellipsoid, or on a flat world's plane [m].
 * @param isFlat - True in a flat world.
 */
export function placeOnMask({ uniforms }: MaskInShader, offset: Vec3, isFlat: boolean): Vec2 {
  const { reference, scale, middle } = uniforms as unknown as Record<string, Vec3>
  const along = (axis: 'east' | 'meridian' | 'north'): Float => offset.dot(uniforms[axis])
  const east = along('east').add(reference.x).toConst() as Float
  const north = along('north').add(reference.z).toConst() as Float
  if (isFlat) return vec2(east, north).mul(scale.xy).add(0.5)
  const meridian = along('meridian').add(reference.y).toConst() as Float
  const [sine, cosine] = [middle.x, middle.y]
  const radius = vec2(meridian, east).length().toConst() as Float
  const aside = east.mul(east).div(radius.add(meridian)).toConst() as Float
  const z = offset.z.add(middle.z).mul(scale.z)
  const longitude = atan(east, meridian) as unknown as Float
  const latitude = atan(
    north.sub(aside.mul(sine)),
    z.mul(sine).add(radius.mul(cosine))
  ) as unknown as Float
  return vec2(longitude, latitude).mul(scale.xy).add(0.5)
}

/**
 * Shares of materials that a mask paints, 0 beyond its edges; their sum is 1 at most.
 *
 * @param relief - Height of stones about 0, by which edges are frayed.
 */
export function maskShares(
  mask: MaskInShader,
  offset: Vec3,
  isFlat: boolean,
  relief: Float
): OfKinds<Float> {
  const place = placeOnMask(mask, offset, isFlat).toConst() as Vec2
  const isInside = step(0, place.x)
    .mul(step(place.x, 1))
    .mul(step(0, place.y))
    .mul(step(place.y, 1))
  const read = texture(mask.texture, place) as unknown as Vec4
  const frayed = (share: Vec4): Vec4 =>
    share.add(share.mul(share.oneMinus()).mul(relief).mul(FRAYED)).clamp(0, 1)
  const used = vec4(...([0, 1, 2, 3].map(n => (mask.materials[n] ? 1 : 0)) as [number]))
  const painted = frayed(read).mul(used).mul(isInside).toConst() as Vec4
  const sum = painted.dot(vec4(1)).max(1)
  const shares = painted.div(sum).toConst() as Vec4
  const channels = [shares.x, shares.y, shares.z, shares.w]
  return ofKinds(kind =>
    mask.materials.reduce<Float>(
      (share, material, n) => (material === kind ? share.add(channels[n]) : share),
      float(0)
    )
  )
}
