/**
 * Gauss–Legendre rule on [0, 1].
 *
 * @param count - Number of nodes, ≥ 1.
 * @returns Ascending nodes and their weights, which sum to 1.
 */
export function gaussLegendre(count: number): { nodes: number[]; weights: number[] } {
  const nodes: number[] = []
  const weights: number[] = []
  for (let i = 0; i < count; i++) {
    // Newton's method on P_n from Tricomi's estimate of its roots.
    let x = Math.cos((Math.PI * (i + 0.75)) / (count + 0.5))
    let derivative = 0
    for (let round = 0; round < 50; round++) {
      let value = 1
      let previous = 0
      for (let k = 1; k <= count; k++) {
        ;[value, previous] = [((2 * k - 1) * x * value - (k - 1) * previous) / k, value]
      }
      derivative = (count * (x * value - previous)) / (x * x - 1)
      const change = value / derivative
      x -= change
      if (Math.abs(change) < 1e-15) break
    }
    nodes.push((1 - x) / 2)
    weights.push(1 / ((1 - x * x) * derivative ** 2))
  }
  return { nodes, weights }
}

/**
 * Weights of the integral from 0 to a position of the polynomial through values at some nodes.
 *
 * @param nodes - No two the same.
 */
export function weightsTo(nodes: readonly number[], position: number): number[] {
  return nodes.map(node => {
    // Lagrange's polynomial that is 1 at this node and 0 at the others, lowest power first.
    let polynomial = [1]
    for (const other of nodes) {
      if (other === node) continue
      const raised = [0, ...polynomial]
      polynomial = raised.map((c, i) => (c - other * (polynomial[i] ?? 0)) / (node - other))
    }
    return polynomial.reduce((sum, c, i) => sum + (c * position ** (i + 1)) / (i + 1), 0)
  })
}
