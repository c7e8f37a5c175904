type Vector = readonly [number, number, number]

const SLICES = 20_000

/** Float64 twin of `meanInverseSquare`, by the midpoint rule along the line. Lengths [m], result [1/m²]. */
export function meanInverseSquareOf(start: Vector, end: Vector, softness: number): number {
  let sum = 0
  for (let i = 0; i < SLICES; i++) {
    const t = (i + 0.5) / SLICES
    const square = start.reduce((all, from, axis) => all + (from + t * (end[axis] - from)) ** 2, 0)
    sum += 1 / (square + softness ** 2)
  }
  return sum / SLICES
}
