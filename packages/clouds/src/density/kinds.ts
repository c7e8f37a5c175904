import { isStorm } from '../layers/storms'
import type { CloudField } from './CloudField'

// Kinds of clouds that a shader has code for. Code that is not run costs time as well: it takes registers.

/** The kinds of a field's layers, as text. */
export const kindsOf = ({ layers }: CloudField): string =>
  [...layers].map(({ parameters }) => (isStorm(parameters) ? 's' : 'c')).join('')

/** A field for shaders that are compiled anew whenever `kindsOf` it changes: they have code for the kinds that it has, and no other. */
export const compiledByKinds = (field: CloudField): CloudField =>
  Object.create(field, { kinds: { get: () => kindsOf(field) } }) as CloudField

/**
 * True for a layer of storms, false for others; undefined where the shader is to find out.
 *
 * @param index - Index of the layer, if the compiler knows it.
 */
export function hasStorms({ kinds }: CloudField, index?: number): boolean | undefined {
  if (kinds === undefined) return undefined
  if (index !== undefined) return kinds[index] === 's'
  return kinds.includes('c') && kinds.includes('s') ? undefined : kinds[0] === 's'
}

/** True if some layer is known to be one of storms. */
export const knowsStorms = ({ kinds }: CloudField): boolean => kinds?.includes('s') === true
