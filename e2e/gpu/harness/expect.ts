/** |actual − expected| may be up to `absolute + relative · |expected|`. */
export interface Tolerance {
  absolute?: number
  relative?: number
}

export function expectTrue(condition: boolean, message: string): void {
  if (!condition) throw new Error(message)
}

/** Compares numbers one by one; NaN never passes. The error names the worst one. */
export function expectClose(
  actual: number | ArrayLike<number>,
  expected: number | ArrayLike<number>,
  { absolute = 0, relative = 0 }: Tolerance,
  label = 'value'
): void {
  const got = typeof actual === 'number' ? [actual] : actual
  const want = typeof expected === 'number' ? [expected] : expected
  if (got.length !== want.length) {
    throw new Error(`${label}: ${got.length} numbers, expected ${want.length}`)
  }
  let worst = -1
  let worstExcess = 0
  for (let i = 0; i < want.length; i++) {
    const allowed = absolute + relative * Math.abs(want[i])
    const difference = Math.abs(got[i] - want[i])
    const excess = Number.isNaN(difference) ? Infinity : difference - allowed
    if (excess > worstExcess) {
      worst = i
      worstExcess = excess
    }
  }
  if (worst >= 0) {
    throw new Error(
      `${label}[${worst}]: got ${got[worst]}, expected ${want[worst]} ` +
        `within ${absolute} + ${relative} × |expected|`
    )
  }
}

export function expectFinite(values: ArrayLike<number>, label = 'value'): void {
  for (let i = 0; i < values.length; i++) {
    if (!Number.isFinite(values[i])) throw new Error(`${label}[${i}] is ${values[i]}`)
  }
}
