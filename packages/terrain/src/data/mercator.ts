/** Latitude at which the square of Web Mercator ends [rad]. */
export const MERCATOR_LIMIT = Math.atan(Math.sinh(Math.PI))

/** Latitude from which on heights blend to those of the coarsest level, whose rows have few tiles [rad]. */
export const POLAR = MERCATOR_LIMIT - 0.01

/** Column of a longitude: 0 at −180°, 1 at 180°. */
export const mercatorX = (longitude: number): number => 0.5 + longitude / (2 * Math.PI)

/** Row of a geodetic latitude: 0 at 85.05° north, 1 at 85.05° south, and finite at the poles. */
export const mercatorY = (latitude: number): number =>
  0.5 - Math.asinh(Math.tan(latitude)) / (2 * Math.PI)

/** Geodetic latitude of a row [rad]. */
export const mercatorLatitude = (y: number): number => Math.atan(Math.sinh(2 * Math.PI * (0.5 - y)))

const POLAR_ROW = mercatorY(POLAR)

/** True for a row that is nearer to a pole than `POLAR`. */
export const isPolar = (y: number): boolean => y < POLAR_ROW || y > 1 - POLAR_ROW

/** Tiles have numbers as keys: exact up to level 23. */
const LEVELS = 32

/**
 * Key of a tile; columns wrap around the planet, rows end at its edges.
 *
 * @param wide - Tiles of level 0 from west to east.
 */
export function tileKey(z: number, x: number, y: number, wide = 1): number {
  const columns = wide * 2 ** z
  const column = ((x % columns) + columns) % columns
  const row = Math.min(Math.max(y, 0), 2 ** z - 1)
  return (row * columns + column) * LEVELS + z
}

/** Level, column and row of a key. */
export function tileOfKey(key: number, wide = 1): { z: number; x: number; y: number } {
  const z = key % LEVELS
  const index = Math.floor(key / LEVELS)
  const columns = wide * 2 ** z
  return { z, x: index % columns, y: Math.floor(index / columns) }
}
