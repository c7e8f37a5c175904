/**
 * Preconditions of public functions. `where` is the class or function that the user called and, for a
 * method, its name: every message reads `where: name must be …, got value`.
 */
interface XYZ {
  readonly x: number
  readonly y: number
  readonly z: number
}

/**
 * Every error of these packages.
 *
 * @param value - Value that was given, if that is the matter: strings are quoted, arrays and plain objects
 *   shown short, other objects by their class.
 */
export function fail(where: string, rule: string, ...value: [unknown?]): never {
  const got = value.length > 0 ? `, got ${describe(value[0])}` : ''
  throw new Error(`${where}: ${rule}${got}`)
}

/** @throws If it is no finite number. */
export function checkFinite(where: string, name: string, value: number): void {
  if (!Number.isFinite(value)) fail(where, `${name} must be a finite number`, value)
}

/** @throws If it is no finite number > 0. */
export function checkPositive(where: string, name: string, value: number): void {
  if (!(Number.isFinite(value) && value > 0)) {
    fail(where, `${name} must be positive and finite`, value)
  }
}

/** @throws If it is no finite number ≥ 0. */
export function checkNonNegative(where: string, name: string, value: number): void {
  if (!(Number.isFinite(value) && value >= 0)) {
    fail(where, `${name} must be finite and ≥ 0`, value)
  }
}

/** @throws If it is neither true nor false. */
export function checkBoolean(where: string, name: string, value: boolean): void {
  if (typeof value !== 'boolean') fail(where, `${name} must be true or false`, value)
}

/** @throws If it is none of the choices; the message lists them. */
export function checkChoice<T>(where: string, name: string, value: T, choices: readonly T[]): void {
  if (choices.includes(value)) return
  const texts = choices.map(choice => describe(choice))
  fail(where, `${name} must be ${texts.slice(0, -1).join(', ')} or ${texts.at(-1)}`, value)
}

/** @throws If it is outside [−90, 90] [°]. */
export function checkLatitude(where: string, latitude: number): void {
  if (!(Number.isFinite(latitude) && Math.abs(latitude) <= 90)) {
    fail(where, 'latitude must be in [−90, 90]', latitude)
  }
}

/** @throws If it is no place, or a coordinate is missing or out of its range. */
export function checkPlace(
  where: string,
  name: string,
  place: { readonly longitude: number; readonly latitude: number; readonly height?: number }
): void {
  if (typeof place !== 'object' || place === null || Array.isArray(place)) {
    fail(where, `${name} must be { longitude, latitude, height } [degrees, metres]`, place)
  }
  // Places may have names and dates of their own, but no misspelt coordinates.
  const names = ['longitude', 'latitude', 'height']
  for (const name of isPlain(place) ? Object.keys(place) : []) {
    if (!names.includes(name) && nearestName(name, names)) {
      failUnknown(where, 'option', name, names)
    }
  }
  checkFinite(where, 'longitude', place.longitude)
  checkLatitude(where, place.latitude)
  checkFinite(where, 'height', place.height ?? 0)
}

/** @throws If it is no vector of finite components. */
export function checkVector(where: string, name: string, vector: XYZ): void {
  if (typeof vector !== 'object' || vector === null || !('x' in vector)) {
    fail(where, `${name} must be a Vector3`, vector)
  }
  if (![vector.x, vector.y, vector.z].every(Number.isFinite)) {
    fail(where, `${name} must have finite components`, vector)
  }
}

/** @throws If it is no vector of finite components, or zero. */
export function checkDirection(where: string, name: string, direction: XYZ): void {
  checkVector(where, name, direction)
  const { x, y, z } = direction
  if (!(x || y || z)) fail(where, `${name} must not be zero`, direction)
}

/** @throws If it is no valid date. */
export function checkDate(where: string, date: Date): void {
  if (!(date instanceof Date) || Number.isNaN(date.getTime())) {
    fail(where, 'date must be a valid Date', date)
  }
}

/** @throws If it is no matrix of finite elements. */
export function checkMatrix(
  where: string,
  name: string,
  matrix: { readonly elements: readonly number[] }
): void {
  if (!matrix || !('isMatrix4' in matrix)) fail(where, `${name} must be a Matrix4`, matrix)
  if (!matrix.elements.every(Number.isFinite)) {
    fail(where, `${name} must have finite elements`, matrix.elements)
  }
}

/**
 * @param names - All options that there are.
 * @returns The options.
 * @throws If they are no plain object, or have an option of another name; the message has the nearest.
 */
export function checkOptions<T extends object>(
  where: string,
  options: T,
  ...names: readonly (keyof T & string)[]
): T {
  if (!isPlain(options)) fail(where, `options must be an object such as { ${names[0]} }`, options)
  for (const name of Object.keys(options)) {
    if (!(names as readonly string[]).includes(name)) failUnknown(where, 'option', name, names)
  }
  return options
}

/** Name that another one was probably meant to be; undefined if none is near. */
function nearestName(name: string, names: readonly string[]): string | undefined {
  const edits = names.map(other => editsBetween(name.toLowerCase(), other.toLowerCase()))
  const least = Math.min(...edits)
  return least <= Math.max(2, name.length / 3) ? names[edits.indexOf(least)] : undefined
}

/** Says that a name is unknown, and which one was meant or what there are. */
export function failUnknown(
  where: string,
  kind: string,
  name: string,
  names: readonly string[]
): never {
  const nearest = nearestName(name, names)
  const hint = nearest ? `did you mean '${nearest}'?` : `there are ${names.join(', ')}`
  fail(where, `unknown ${kind} '${name}', ${hint}`)
}

/**
 * Assigns options to the properties of the same names, or none if a name is unknown or a property
 * refuses its value. Undefined leaves a property as it is.
 */
export function setOptions<T extends object, O extends object>(
  where: string,
  target: T,
  options: O,
  ...names: readonly (keyof T & keyof O & string)[]
): T {
  checkOptions(where, options, ...names)
  const given = Object.entries(options).filter(([, value]) => value !== undefined)
  const before = given.map(([name]) => [name, target[name as keyof T]])
  try {
    return Object.assign(target, Object.fromEntries(given))
  } catch (error) {
    Object.assign(target, Object.fromEntries(before))
    throw error
  }
}

/** Levenshtein distance: letters added, left out or replaced between two words. */
function editsBetween(a: string, b: string): number {
  let row = Array.from({ length: b.length + 1 }, (_, j) => j)
  for (const letter of a) {
    const next = [row[0] + 1]
    for (let j = 0; j < b.length; j++) {
      const replaced = row[j] + (letter === b[j] ? 0 : 1)
      next.push(Math.min(replaced, row[j + 1] + 1, next[j] + 1))
    }
    row = next
  }
  return row[b.length]
}

/** True of an object that no class has made. */
function isPlain(value: unknown): value is object {
  if (typeof value !== 'object' || value === null) return false
  const prototype: unknown = Object.getPrototypeOf(value)
  return prototype === null || Object.getPrototypeOf(prototype) === null
}

/** Parts of an array or object that are shown. */
const SHOWN = 4

/** Letters of a string that are shown. */
const LETTERS = 60

function describe(value: unknown, isPart = false): string {
  if (typeof value === 'string') {
    return `'${value.length > LETTERS ? `${value.slice(0, LETTERS)}…` : value}'`
  }
  if (typeof value === 'function') return `the function ${value.name}`
  if (value instanceof Date || typeof value !== 'object' || value === null) return String(value)
  const isArray = Array.isArray(value)
  if (isArray || isPlain(value)) {
    const parts = Object.entries(value)
    const shown = parts
      .slice(0, isPart ? 0 : SHOWN)
      .map(([name, part]) => (isArray ? '' : `${name}: `) + describe(part, true))
    if (parts.length > shown.length) shown.push('…')
    const text = shown.join(', ')
    return isArray ? `[${text}]` : text === '' ? '{}' : `{ ${text} }`
  }
  if ('isVector3' in value) {
    const { x, y, z } = value as unknown as XYZ
    return `(${x}, ${y}, ${z})`
  }
  // Minifiers shorten the names of classes, but not three's own names for types.
  const { name } = (value as object).constructor
  const type = name.length > 2 ? name : (value as { type?: unknown }).type
  if (typeof type !== 'string') return 'an object'
  return `${/^[AEIO]/.test(type) ? 'an' : 'a'} ${type}`
}
