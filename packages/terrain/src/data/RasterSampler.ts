/** Value of a raster between its pixels, and its slope along both axes. */
export interface RasterSample {
  value: number
  /** Per pixel to the right. */
  x: number
  /** Per pixel downward. */
  y: number
}

const weights = new Float64Array(4)
const slopes = new Float64Array(4)
const rowValues = new Float64Array(4)
const rowSlopes = new Float64Array(4)

/** Weights of four neighbours, twice as large, for a place between the second and the third. */
const firstWeight = (t: number): number => ((2 - t) * t - 1) * t
const secondWeight = (t: number): number => (3 * t - 5) * t * t + 2
const thirdWeight = (t: number): number => ((4 - 3 * t) * t + 1) * t
const fourthWeight = (t: number): number => (t - 1) * t * t

function setWeights(t: number): void {
  weights[0] = firstWeight(t) * 0.5
  weights[1] = secondWeight(t) * 0.5
  weights[2] = thirdWeight(t) * 0.5
  weights[3] = fourthWeight(t) * 0.5
}

/** Weights of the same for the slope. */
function setSlopes(t: number): void {
  slopes[0] = ((4 - 3 * t) * t - 1) * 0.5
  slopes[1] = (9 * t - 10) * t * 0.5
  slopes[2] = ((8 - 9 * t) * t + 1) * 0.5
  slopes[3] = (3 * t - 2) * t * 0.5
}

/**
 * Bicubic interpolation through the pixels, with continuous slopes.
 *
 * @param pixelAt - Value of a pixel, any column and row: those beyond the edges too.
 * @param x - Place in pixels, like `y`: whole numbers are centres.
 * @see Catmull & Rom 1974, "A class of local interpolating splines", §4: cubic, with tension 1/2
 */
export function sampleRaster(
  pixelAt: (column: number, row: number) => number,
  x: number,
  y: number,
  target: RasterSample
): RasterSample {
  const column = Math.floor(x)
  const row = Math.floor(y)
  setWeights(x - column)
  setSlopes(x - column)
  for (let j = 0; j < 4; j++) {
    let value = 0
    let slope = 0
    for (let i = 0; i < 4; i++) {
      const pixel = pixelAt(column + i - 1, row + j - 1)
      value += weights[i] * pixel
      slope += slopes[i] * pixel
    }
    rowValues[j] = value
    rowSlopes[j] = slope
  }
  setWeights(y - row)
  setSlopes(y - row)
  target.value = target.x = target.y = 0
  for (let j = 0; j < 4; j++) {
    target.value += weights[j] * rowValues[j]
    target.x += weights[j] * rowSlopes[j]
    target.y += slopes[j] * rowValues[j]
  }
  return target
}

/**
 * Value alone, where all sixteen pixels about the place are in the raster.
 *
 * @param stride - Pixels of a row.
 */
export function valueInside(values: Float32Array, stride: number, x: number, y: number): number {
  const column = Math.floor(x)
  const row = Math.floor(y)
  const t = x - column
  const a = firstWeight(t)
  const b = secondWeight(t)
  const c = thirdWeight(t)
  const d = fourthWeight(t)
  const u = y - row
  const i = (row - 1) * stride + column - 1
  const j = i + stride
  const k = j + stride
  const l = k + stride
  return (
    (firstWeight(u) * (a * values[i] + b * values[i + 1] + c * values[i + 2] + d * values[i + 3]) +
      secondWeight(u) *
        (a * values[j] + b * values[j + 1] + c * values[j + 2] + d * values[j + 3]) +
      thirdWeight(u) * (a * values[k] + b * values[k + 1] + c * values[k + 2] + d * values[k + 3]) +
      fourthWeight(u) *
        (a * values[l] + b * values[l + 1] + c * values[l + 2] + d * values[l + 3])) /
    4
  )
}

/** Part of a map that a raster shows. */
export interface RasterWindow {
  /** Pixels per unit of the map, across and down. */
  readonly scale: readonly [number, number]
  /** First column and row of the raster. */
  readonly first: readonly [number, number]
}

/** Values at many places, all as {@link valueInside} has them: in one loop that does nothing else. */
export function fillInside(
  values: Float32Array,
  stride: number,
  { x, y }: { readonly x: Float64Array; readonly y: Float64Array },
  { scale: [wide, tall], first: [left, top] }: RasterWindow,
  target: Float32Array
): Float32Array {
  for (let i = 0; i < target.length; i++) {
    target[i] = valueInside(values, stride, x[i] * wide - 0.5 - left, y[i] * tall - 0.5 - top)
  }
  return target
}

/** Most that the interpolation goes beyond the values about it, per difference of the largest and smallest [–]. */
export const OVERSHOOT = 0.29

/** Bound of its slope along an axis, per largest difference of neighbours on it [–]. */
export const STEEPENING = 1.6
