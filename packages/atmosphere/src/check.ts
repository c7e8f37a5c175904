import { Matrix4 } from 'three'
import type { Camera, OrthographicCamera } from 'three'
import { checkOptions, fail } from '@welkin/geo'

/** Defaults, and the options that are not undefined in place of them. */
export function withDefaults<T extends object>(where: string, defaults: T, options: object): T {
  const names = Object.keys(defaults) as never[]
  const given = Object.entries(checkOptions(where, options, ...names)).filter(
    ([, value]) => value !== undefined
  )
  return { ...defaults, ...Object.fromEntries(given) }
}

/** @throws If it is not a number from `min` to `max`. */
export function checkRange(
  where: string,
  name: string,
  value: unknown,
  min: number,
  max: number
): void {
  if (!(typeof value === 'number' && value >= min && value <= max)) {
    fail(where, `${name} must be in [${min}, ${max}]`, value)
  }
}

/** @throws If it is not four numbers from `min` to `max`. */
export function checkSpectrum(
  where: string,
  name: string,
  values: readonly number[],
  max: number
): void {
  if (!Array.isArray(values) || values.length !== 4) {
    fail(where, `${name} must be an array of 4 values`, values)
  }
  values.forEach((value, i) => checkRange(where, `${name}[${i}]`, value, 0, max))
}

/** @throws If it is not two altitudes that rise. */
export function checkFade(where: string, fade: readonly [number, number]): void {
  if (!Array.isArray(fade) || fade.length !== 2) {
    fail(where, 'fade must be an array of 2 altitudes', fade)
  }
  fade.forEach((value, i) => checkRange(where, `fade[${i}]`, value, -1e7, Infinity))
  if (!(fade[1] > fade[0])) fail(where, 'fade must rise', fade)
}

/** @throws If it is neither null nor a matrix. */
export function checkOrientation(where: string, value: Matrix4 | null): void {
  if (value !== null && !(value instanceof Matrix4 && value.elements.every(Number.isFinite))) {
    fail(where, 'orientation must be a Matrix4 or null', value)
  }
}

/** @throws If it is no camera. */
export function checkCamera(where: string, camera: Camera): void {
  if (!camera?.isCamera) fail(where, 'camera must be a Camera', camera)
}

/** @throws If a light's rays are not parallel, or it is one of another atmosphere. */
export function checkShadowLight(
  where: string,
  light: { readonly shadow?: { readonly camera: Camera }; readonly atmosphere?: object },
  atmosphere: object
): void {
  const camera = (light?.shadow?.camera ?? null) as Partial<OrthographicCamera> | null
  if (!camera?.isOrthographicCamera) fail(where, 'light must be a DirectionalLight', light)
  if ((light.atmosphere ?? atmosphere) !== atmosphere)
    fail(where, 'light must be of the same atmosphere', light)
}
