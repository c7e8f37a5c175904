/**
 * Preconditions of public functions. `where` is the class or function and, for a method, its name:
 * every message reads `where: name must be …, got value`.
 */
interface XYZ {
  readonly x: number
  readonly y: number
  readonly z: number
}

export function fail(where: string, rule: string, value: unknown): never {
  throw new Error(`${where}: ${rule}, got ${describe(value)}`)
}

export function checkFinite(where: string, name: string, value: number): void {
  if (!Number.isFinite(value)) fail(where, `${name} must be a finite number`, value)
}

export function checkPositive(where: string, name: string, value: number): void {
  if (!(Number.isFinite(value) && value > 0)) {
    fail(where, `${name} must be positive and finite`, value)
  }
}

export function checkNonNegative(where: string, name: string, value: number): void {
  if (!(Number.isFinite(value) && value >= 0)) {
    fail(where, `${name} must be finite and ≥ 0`, value)
  }
}

export function checkLatitude(where: string, latitude: number): void {
  if (!(Number.isFinite(latitude) && Math.abs(latitude) <= 90)) {
    fail(where, 'latitude must be in [−90, 90]', latitude)
  }
}

export function checkVector(where: string, name: string, vector: XYZ): void {
  const isFinite =
    Number.isFinite(vector?.x) && Number.isFinite(vector?.y) && Number.isFinite(vector?.z)
  if (!isFinite) {
    fail(where, `${name} must have finite components`, vector)
  }
}

export function checkDirection(where: string, name: string, direction: XYZ): void {
  checkVector(where, name, direction)
  if (direction.x === 0 && direction.y === 0 && direction.z === 0) {
    fail(where, `${name} must not be zero`, direction)
  }
}

export function checkDate(where: string, date: Date): void {
  if (!(date instanceof Date) || Number.isNaN(date.getTime())) {
    fail(where, 'date must be a valid Date', date)
  }
}

function describe(value: unknown): string {
  if (value instanceof Date || typeof value !== 'object' || value === null) return String(value)
  if ('x' in value && 'y' in value && 'z' in value) {
    return `(${String(value.x)}, ${String(value.y)}, ${String(value.z)})`
  }
  return Array.isArray(value) ? `[${value.join(', ')}]` : (value.constructor?.name ?? 'object')
}
