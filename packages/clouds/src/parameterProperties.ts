/** A class whose parameters are changed by `set`. */
interface Parametrized {
  set(changes: object): unknown
}

/**
 * Makes a property of each parameter: it reads the object of all parameters, and assigning to it calls `set`.
 *
 * @param prototype - Prototype of the class.
 * @param names - An object with all parameters.
 * @param all - Name of the property that has the object of all parameters.
 */
export function parameterProperties<K extends string>(
  prototype: Parametrized & Readonly<Record<K, object>>,
  names: object,
  all: K
): void {
  for (const name in names) {
    Object.defineProperty(prototype, name, {
      get(this: Readonly<Record<K, Record<string, unknown>>>) {
        return this[all][name]
      },
      set(this: Parametrized, value: unknown) {
        this.set({ [name]: value })
      }
    })
  }
}
