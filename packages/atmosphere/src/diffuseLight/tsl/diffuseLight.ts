import { float, vec2 } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import type { Table } from '../../tables/TableAtlas'
import { DIFFUSE_LAYOUT, DIFFUSE_SIZE, RADIANCE_SCALE } from '../../tables/tableSizes'
import type { Float, Vec4 } from '../../tsl-types'
import { diffuseLightCosine, diffuseLightSlope, diffuseLightOrigin } from '../cpu/diffuseLight'
import type { Moments } from './moments'
import { asinh, sinh } from '../../math/tsl/trigonometry'

const [COLUMNS, ROWS] = DIFFUSE_SIZE
const [TILE_COLUMNS, TILE_ROWS] = DIFFUSE_LAYOUT

/**
 * Distance that look-ups keep from the middles of a tile's outermost texels [texels]: float32 rounds by
 * less. Beside deepest night lies the next tile's noon, a hundred million times as bright.
 */
const INSET = 1 / 1024

/** asinh of the light's cosine μ_s, as the table spaces its columns: they crowd about the horizon. */
export function compressCosine(cosLight: Float): Float {
  return asinh(cosLight.sub(diffuseLightCosine.centre).div(diffuseLightCosine.width).toConst())
}

/** The light's cosine from {@link compressCosine} of it. */
export function expandCosine(x: Float): Float {
  return sinh(x).mul(diffuseLightCosine.width).add(diffuseLightCosine.centre)
}

/** Position of the light's cosine among the columns, in [0, 1]. */
function lightColumn(cosLight: Float): Float {
  return compressCosine(cosLight).sub(diffuseLightOrigin).mul(diffuseLightSlope).clamp()
}

/** Position of an altitude among the rows, in [0, 1]. Rows crowd at the ground. */
function altitudeRow({ thickness }: AtmosphereUniforms, altitude: Float): Float {
  return altitude.div(thickness).clamp().sqrt()
}

/**
 * A function that reads a tile of the diffuse-light table, by its column and row, at an altitude and angle of the light; the column may differ by pixel.
 */
export function diffuseLightReader(
  uniforms: AtmosphereUniforms,
  table: Table,
  altitude: Float,
  cosLight: Float
): (column: Float | number, row: number) => Vec4 {
  const uv = vec2(lightColumn(cosLight), altitudeRow(uniforms, altitude))
    .mul(vec2(COLUMNS - 1 - 2 * INSET, ROWS - 1 - 2 * INSET))
    .add(0.5 + INSET)
    .div(vec2(COLUMNS * TILE_COLUMNS, ROWS * TILE_ROWS))
    .toConst()
  return (column, row) =>
    table.sample(uv.add(vec2(column, row).div(vec2(TILE_COLUMNS, TILE_ROWS)))).toConst()
}

/**
 * Moments of the diffuse light at a point, for unit irradiance of the light source, times `RADIANCE_SCALE`.
 *
 * @param table - Diffuse-light table.
 * @param altitude - Above the ground, in [0, thickness] [m].
 * @param cosLight - μ_s, cosine of the light's zenith angle.
 */
export function diffuseMoments(
  uniforms: AtmosphereUniforms,
  table: Table,
  altitude: Float,
  cosLight: Float
): Moments<Vec4> {
  const read = diffuseLightReader(uniforms, table, altitude, cosLight)
  return {
    m00: read(0, 0),
    m10: read(1, 0),
    m11: read(0, 1),
    m20: read(1, 1),
    m21: read(0, 2),
    m22: read(1, 2)
  }
}

/**
 * Diffuse irradiance on horizontal ground, for unit irradiance of the light source.
 *
 * @param table - Diffuse-light table.
 * @param cosLight - μ_s, cosine of the light's zenith angle.
 */
export function groundIrradiance(
  uniforms: AtmosphereUniforms,
  table: Table,
  cosLight: Float
): Vec4 {
  return diffuseLightReader(uniforms, table, float(0), cosLight)(0, 3).div(RADIANCE_SCALE)
}
