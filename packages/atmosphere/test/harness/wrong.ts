import { describe, expect, it } from 'vitest'

/** Value of a type that the compiler would not let pass. */
export const wrong = (value: unknown): never => value as never

/** End of the message where a moon is given in place of its light. */
export const notASource = "must be a LightSource, such as a moon's source, got a Moon"

/** Beginning of the message where options are no object. */
export const noOptions = 'options must be an object such as {'

/** Tests that calls throw, each with its message in the error's: class or function, parameter, value. */
export function throwsEach(
  subject: string,
  cases: readonly [message: string, call: () => unknown][]
): void {
  describe(`wrong use of ${subject} throws with name and value`, () => {
    it.each(cases)('%s', (message, call) => {
      expect(call).toThrow(message)
    })
  })
}
