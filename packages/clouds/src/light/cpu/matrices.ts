/** Rows of numbers. */
export type Matrix = number[][]

/** Σ a_i b_i. */
export const dot = (a: readonly number[], b: readonly number[]): number =>
  a.reduce((sum, value, i) => sum + value * b[i], 0)

/** Square matrix with as many rows as `range` has numbers, of elements `term(row, column)`. */
export const matrix = (
  range: readonly unknown[],
  term: (row: number, column: number) => number
): Matrix => range.map((_, i) => range.map((__, j) => term(i, j)))

/** a b. */
export function product(a: Matrix, b: Matrix): Matrix {
  const columns = b[0].map((_, j) => b.map(row => row[j]))
  return a.map(row => columns.map(column => dot(row, column)))
}

/**
 * Eigenvalues and eigenvectors (columns of `vectors`) of a symmetric matrix, by Jacobi's rotations;
 * `a` is destroyed.
 */
export function symmetricEigen(a: Matrix): { values: number[]; vectors: Matrix } {
  const size = a.length
  const vectors = matrix(a, (i, j) => (i === j ? 1 : 0))
  for (let sweep = 0; sweep < 30; sweep++) {
    let rest = 0
    for (let p = 0; p < size; p++) {
      for (let q = p + 1; q < size; q++) {
        if (a[p][q] === 0) continue
        rest += a[p][q] ** 2
        const theta = (a[q][q] - a[p][p]) / (2 * a[p][q])
        const tangent = Math.sign(theta || 1) / (Math.abs(theta) + Math.hypot(theta, 1))
        const cosine = 1 / Math.hypot(tangent, 1)
        const sine = tangent * cosine
        const turned = (x: number, y: number): [number, number] => [
          cosine * x - sine * y,
          sine * x + cosine * y
        ]
        for (const row of [...a, ...vectors]) [row[p], row[q]] = turned(row[p], row[q])
        for (let k = 0; k < size; k++) [a[p][k], a[q][k]] = turned(a[p][k], a[q][k])
      }
    }
    if (rest < 1e-30) break
  }
  return { values: a.map((row, i) => row[i]), vectors }
}

/** LU decomposition with partial pivoting of a square matrix, which is destroyed. @returns A solver. */
export function factorize(a: Matrix): (right: number[]) => number[] {
  const size = a.length
  const order = a.map((_, i) => i)
  for (let k = 0; k < size; k++) {
    let pivot = k
    for (let i = k + 1; i < size; i++) if (Math.abs(a[i][k]) > Math.abs(a[pivot][k])) pivot = i
    ;[a[k], a[pivot]] = [a[pivot], a[k]]
    ;[order[k], order[pivot]] = [order[pivot], order[k]]
    for (let i = k + 1; i < size; i++) {
      const factor = (a[i][k] /= a[k][k])
      if (factor === 0) continue
      for (let j = k + 1; j < size; j++) a[i][j] -= factor * a[k][j]
    }
  }
  return right => {
    const x = order.map(i => right[i])
    for (let i = 0; i < size; i++) for (let j = 0; j < i; j++) x[i] -= a[i][j] * x[j]
    for (let i = size - 1; i >= 0; i--) {
      for (let j = i + 1; j < size; j++) x[i] -= a[i][j] * x[j]
      x[i] /= a[i][i]
    }
    return x
  }
}
