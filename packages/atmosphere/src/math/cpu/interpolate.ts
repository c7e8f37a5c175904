/** Bilinear look-up among rows × columns of `size` values each. */
export function interpolate(
  values: Float64Array,
  columns: number,
  rows: number,
  size: number,
  x: number,
  y: number,
  target: Float64Array
): void {
  const column = Math.min(Math.max(Math.floor(x), 0), columns - 2)
  const row = Math.min(Math.max(Math.floor(y), 0), rows - 2)
  const u = Math.min(Math.max(x - column, 0), 1)
  const v = Math.min(Math.max(y - row, 0), 1)
  const a = (row * columns + column) * size
  const b = a + columns * size
  for (let i = 0; i < size; i++) {
    const lower = values[a + i] * (1 - u) + values[a + size + i] * u
    const upper = values[b + i] * (1 - u) + values[b + size + i] * u
    target[i] = lower * (1 - v) + upper * v
  }
}
