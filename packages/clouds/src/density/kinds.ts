import { isStorm } from '../layers/storms'
import type { CloudField } from './CloudField'

/** The kinds of a field's layers, as text. */
export const kindsOf = ({ layers }: CloudField): string =>
  [...layers].map(({ parameters }) => (isStorm(parameters) ? 's' : 'c')).join('')

/**
 * A field for shaders that are compiled anew whenever `kindsOf` it changes: they have no code for kinds of clouds that there are not,
 * which takes a fifth of the march's time even where it is not run.
 */
export const compiledByKinds = (field: CloudField): CloudField =>
  Object.create(field, { storms: { value: isStorm } }) as CloudField
