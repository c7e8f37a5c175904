import { checkOptions, checkRange } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'

/**
 * @param others - Names of values that have no range.
 * @throws If there is a value of another name, or one is not a number from the least to the greatest of its.
 */
export function checkRanges<K extends string>(
  where: string,
  values: Readonly<Record<NoInfer<K>, number>>,
  ranges: Readonly<Record<K, readonly [number, number]>>,
  ...others: string[]
): void {
  checkOptions(where, values, ...Object.keys(ranges), ...others)
  for (const name in ranges) {
    checkRange(where, name, values[name], ...(ranges[name] as [number, number]))
  }
}

/** What a name stands for. @throws If it is none of the names. */
export function named<T extends object>(
  where: string,
  what: string,
  values: T,
  name: unknown
): T[keyof T] {
  if (!Object.hasOwn(values, name as PropertyKey)) {
    fail(where, `${what} must be one of ${Object.keys(values).join(', ')}`, name)
  }
  return values[name as keyof T]
}

/** @throws If they are no clouds. */
export function checkClouds(where: string, value: { readonly shadows: unknown }): void {
  if (value?.shadows === undefined) fail(where, 'clouds must be a CloudsNode', value)
}
