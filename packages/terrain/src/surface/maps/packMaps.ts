import { float, texture, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { Texture } from 'three'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { GRAIN_SLOPE } from '../grainTexture'

/** Texture maps of a material of the ground, all of which tile. */
export interface MaterialMaps {
  /** Reflectance; its colour space is the texture's own, as in three. */
  readonly albedo: Texture
  /** Normals in tangent space, green up, as in three; level without it. */
  readonly normal?: Texture | undefined
  /** Roughness in green, as in three; 0.9 without it. */
  readonly roughness?: Texture | undefined
  /** Ambient occlusion in red, as in three; 1 without it. */
  readonly ao?: Texture | undefined
  /** Height in red: where materials meet the higher one shows, and near the feet the ground has depth; level without it. */
  readonly height?: Texture | undefined
  /** Length of their side on the ground, default 2 [m]. */
  readonly side?: number | undefined
  /** Height of white over black, in [0, 1], default 0.05 [m]. */
  readonly relief?: number | undefined
}

/** Roughness of materials that have no map of it. */
const ROUGHNESS = 0.9

const read = (map: Texture): Vec4 => texture(map, uv())

/** Reflectance, and share of the sky's light. */
export const colorLayer = ({ albedo, ao }: MaterialMaps): Vec4 => {
  const share: Float = ao === undefined ? float(1) : read(ao).x
  return vec4(read(albedo).xyz as Vec3, share)
}

/** Slopes along both sides in bytes' range, roughness, and height. */
export const reliefLayer = ({ normal, roughness, height }: MaterialMaps): Vec4 => {
  const slope: Vec2 = normal === undefined ? vec2(0) : slopeOf(read(normal).xyz)
  return vec4(
    slope.div(2 * GRAIN_SLOPE).add(0.5),
    roughness === undefined ? float(ROUGHNESS) : read(roughness).y,
    height === undefined ? float(0.5) : read(height).x
  )
}

/** Slope of the surface that has a normal: it falls to where the normal leans. */
const slopeOf = (encoded: Vec3): Vec2 => {
  const normal = encoded.mul(2).sub(1).toConst() as Vec3
  return vec3(normal).xy.div(normal.z.max(0.05)).negate()
}
