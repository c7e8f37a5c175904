import {
  DIFFUSE_LAYOUT,
  DIFFUSE_SIZE,
  DIFFUSE_TILES,
  RADIANCE_SCALE
} from '../../tables/tableSizes'

/**
 * Spacing of the columns of the diffuse-light table over the light's cosine μ_s: evenly in
 * asinh((μ_s − centre)/width), from `min` (22° below the horizon) to 1.
 */
export const diffuseLightCosine = { centre: -0.035, width: 0.12, min: -0.375 } as const

const position = (cosLight: number): number =>
  Math.asinh((cosLight - diffuseLightCosine.centre) / diffuseLightCosine.width)

/** asinh at the first column. */
export const diffuseLightOrigin = /*#__PURE__*/ position(diffuseLightCosine.min)

/** 1/(asinh at the last column − at the first). */
export const diffuseLightSlope = /*#__PURE__*/ (() => 1 / (position(1) - diffuseLightOrigin))()

/** Position of μ_s among the columns, in [0, 1]. */
export function diffuseColumn(cosLight: number): number {
  return Math.min(Math.max((position(cosLight) - diffuseLightOrigin) * diffuseLightSlope, 0), 1)
}

/** μ_s of a column. */
export function diffuseColumnCosine(column: number): number {
  const x = column / (DIFFUSE_SIZE[0] - 1) / diffuseLightSlope + diffuseLightOrigin
  return diffuseLightCosine.centre + diffuseLightCosine.width * Math.sinh(x)
}

/** The diffuse-light table, read back. */
export interface DiffuseLightData {
  /**
   * Texels of four values as they lie in the texture: row by row, tiles as `DIFFUSE_LAYOUT` has them. Rows of a
   * tile are altitudes, from the ground up.
   */
  values: Float32Array
}

/** Index of the texel at a column and row of a tile. */
export function diffuseTexel(tile: number, column: number, row: number): number {
  const [columns, rows] = DIFFUSE_SIZE
  const across = DIFFUSE_LAYOUT[0]
  const y = Math.floor(tile / across) * rows + row
  return (y * across + (tile % across)) * columns + column
}

/**
 * Reads all tiles of the table, bilinearly.
 *
 * @param altitudePart - Altitude over the air's thickness, in [0, 1].
 * @param cosLight - μ_s.
 * @returns A four-value spectrum per tile, for unit irradiance of the light source.
 */
export function sampleDiffuseLight(
  { values }: DiffuseLightData,
  altitudePart: number,
  cosLight: number
): number[][] {
  const [columns, rows] = DIFFUSE_SIZE
  const x = diffuseColumn(cosLight) * (columns - 1)
  const y = Math.sqrt(Math.min(Math.max(altitudePart, 0), 1)) * (rows - 1)
  const column = Math.min(Math.floor(x), columns - 2)
  const row = Math.min(Math.floor(y), rows - 2)
  const [u, v] = [x - column, y - row]
  const corners = [
    [column, row, (1 - u) * (1 - v)],
    [column + 1, row, u * (1 - v)],
    [column, row + 1, (1 - u) * v],
    [column + 1, row + 1, u * v]
  ] as const
  return Array.from({ length: DIFFUSE_TILES }, (_, tile) =>
    [0, 1, 2, 3].map(channel =>
      corners.reduce((sum, [i, j, weight]) => {
        const value = values[4 * diffuseTexel(tile, i, j) + channel]
        return sum + (weight * value) / RADIANCE_SCALE
      }, 0)
    )
  )
}
