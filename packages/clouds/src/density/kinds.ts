import { FragmentPass } from '@welkin/atmosphere'
import { isStorm } from '../layers/storms'
import type { Vec4 } from '../tsl-types'
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

/** A pass with code for the kinds that a field's layers have, compiled anew where layers of storms come or go. */
export class PassByKinds extends FragmentPass {
  readonly #field: CloudField
  /** Kinds that the shader was compiled for. */
  #kinds = ''

  /** @param output - Value of a texel, by the field that it is to read. */
  constructor(name: string, field: CloudField, output: (field: CloudField) => Vec4) {
    super(name, output(compiledByKinds(field)))
    this.#field = field
    const { material } = this
    const key = material.customProgramCacheKey.bind(material)
    material.customProgramCacheKey = () => key() + kindsOf(field)
  }

  override render(...inputs: Parameters<FragmentPass['render']>): void {
    const kinds = kindsOf(this.#field)
    if (kinds !== this.#kinds) this.material.needsUpdate = true
    this.#kinds = kinds
    super.render(...inputs)
  }
}
