/** Numbers in rows. */
export interface Raster {
  readonly width: number
  readonly height: number
  readonly values: Float32Array
}

/** A raster of half the size: means of 2 × 2; the last of an odd number of columns or rows counts twice. */
export function halved({ width, height, values }: Raster): Raster {
  const made = { width: Math.ceil(width / 2), height: Math.ceil(height / 2) }
  const means = new Float32Array(made.width * made.height)
  const at = (x: number, y: number): number =>
    values[Math.min(y, height - 1) * width + Math.min(x, width - 1)]
  for (let y = 0; y < made.height; y++) {
    for (let x = 0; x < made.width; x++) {
      const [i, j] = [2 * x, 2 * y]
      const sum = at(i, j) + at(i + 1, j) + at(i, j + 1) + at(i + 1, j + 1)
      means[y * made.width + x] = sum / 4
    }
  }
  return { ...made, values: means }
}

/** Mean of the values that are numbers; NaN if none is. */
function meanOfNumbers(values: readonly number[]): number {
  const numbers = values.filter(Number.isFinite)
  return numbers.length > 0 ? numbers.reduce((sum, value) => sum + value, 0) / numbers.length : NaN
}

/**
 * Fills what is no number from what is about it: coarser and coarser means, where finer ones have none.
 *
 * @param otherwise - Value where there is no number at all.
 * @returns Same raster.
 */
export function fillHoles(raster: Raster, otherwise: number): Raster {
  const { width, height, values } = raster
  if (values.every(Number.isFinite)) return raster
  if (width === 1 && height === 1) {
    values[0] = otherwise
    return raster
  }
  const coarse = { width: Math.ceil(width / 2), height: Math.ceil(height / 2) }
  const means = new Float32Array(coarse.width * coarse.height)
  const at = (x: number, y: number): number =>
    x < width && y < height ? values[y * width + x] : NaN
  for (let y = 0; y < coarse.height; y++) {
    for (let x = 0; x < coarse.width; x++) {
      const [i, j] = [2 * x, 2 * y]
      means[y * coarse.width + x] = meanOfNumbers([
        at(i, j),
        at(i + 1, j),
        at(i, j + 1),
        at(i + 1, j + 1)
      ])
    }
  }
  fillHoles({ ...coarse, values: means }, otherwise)
  for (let i = 0; i < values.length; i++) {
    if (Number.isFinite(values[i])) continue
    values[i] = means[((i / width) >> 1) * coarse.width + ((i % width) >> 1)]
  }
  return raster
}

/**
 * Least and largest values, and largest differences of neighbours.
 *
 * @param wraps - True if the first column follows the last.
 */
export function boundsOf({ width, height, values }: Raster, wraps: boolean) {
  let [low, high, right, down] = [Infinity, -Infinity, 0, 0]
  for (let i = 0; i < values.length; i++) {
    low = Math.min(low, values[i])
    high = Math.max(high, values[i])
    const isLast = (i + 1) % width === 0
    const next = isLast ? i + 1 - width : i + 1
    if (!isLast || wraps) right = Math.max(right, Math.abs(values[next] - values[i]))
    if (i < (height - 1) * width) down = Math.max(down, Math.abs(values[i + width] - values[i]))
  }
  return { low, high, right, down }
}
