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

type SixTiles = [Vec4, Vec4, Vec4, Vec4, Vec4, Vec4]

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
 * A function that reads a tile of the diffuse-light table at an altitude and angle of the light; `next` is how many tiles farther in its row, which may
 * differ by pixel.
 */
export function diffuseLightReader(
  uniforms: AtmosphereUniforms,
  table: Table,
  altitude: Float,
  cosLight: Float
): (tile: number, next?: Float) => Vec4 {
  const uv = vec2(lightColumn(cosLight), altitudeRow(uniforms, altitude))
    .mul(vec2(COLUMNS - 1 - 2 * INSET, ROWS - 1 - 2 * INSET))
    .add(0.5 + INSET)
    .div(vec2(COLUMNS * TILE_COLUMNS, ROWS * TILE_ROWS))
    .toConst()
  return (tile, next = float(0)) =>
    table.sample(
      uv.add(
        vec2(
          next.add(tile % TILE_COLUMNS).div(TILE_COLUMNS),
          Math.floor(tile / TILE_COLUMNS) / TILE_ROWS
        )
      )
    )
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
  const [m00, m10, m11, m20, m21, m22] = [0, 1, 2, 3, 4, 5].map(tile =>
    read(tile).toConst()
  ) as unknown as SixTiles
  return { m00, m10, m11, m20, m21, m22 }
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
  return diffuseLightReader(uniforms, table, float(0), cosLight)(6).div(RADIANCE_SCALE)
}
