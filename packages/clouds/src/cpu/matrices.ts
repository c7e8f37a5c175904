/** Rows of numbers. */
export type Matrix = number[][]

/** Lower triangle L with L Lᵀ = a, for a symmetric positive definite a. */
export function cholesky(a: Matrix): Matrix {
  const lower = a.map(row => row.map(() => 0))
  for (let i = 0; i < a.length; i++) {
    for (let j = 0; j <= i; j++) {
      let sum = a[i][j]
      for (let k = 0; k < j; k++) sum -= lower[i][k] * lower[j][k]
      lower[i][j] = i === j ? Math.sqrt(sum) : sum / lower[j][j]
    }
  }
  return lower
}

/**
 * Eigenvalues and eigenvectors (columns of `vectors`) of a symmetric matrix, by Jacobi's rotations;
 * `a` is destroyed.
 */
export function symmetricEigen(a: Matrix): { values: number[]; vectors: Matrix } {
  const size = a.length
  const vectors = a.map((row, i) => row.map((_, j) => (i === j ? 1 : 0)))
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
        for (const row of [a, vectors].flat()) {
          ;[row[p], row[q]] = [cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]]
        }
        for (let k = 0; k < size; k++) {
          const [x, y] = [a[p][k], a[q][k]]
          a[p][k] = cosine * x - sine * y
          a[q][k] = sine * x + cosine * y
        }
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
