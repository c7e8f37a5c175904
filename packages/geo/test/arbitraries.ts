import fc from 'fast-check'
import { Vector3 } from 'three'

/** Seed and number of cases: the same cases in every run; a failure still prints its counterexample. */
export const runs = { seed: 20260621, numRuns: 400 }

export const number = (min: number, max: number): fc.Arbitrary<number> =>
  fc.double({ min, max, noNaN: true, noDefaultInfinity: true })

/** Anywhere, with the poles, the equator and both sides of the antimeridian often among them. */
export const longitude = fc.oneof(
  { weight: 4, arbitrary: number(-180, 180) },
  { weight: 1, arbitrary: fc.constantFrom(-180, 180, -179.999999999, 179.999999999, 0, 90, -90) }
)
export const latitude = fc.oneof(
  { weight: 4, arbitrary: number(-90, 90) },
  { weight: 1, arbitrary: fc.constantFrom(-90, 90, -89.9999999999, 89.9999999999, 0) }
)

export const direction = fc.tuple(number(-1, 1), number(-Math.PI, Math.PI)).map(([z, angle]) => {
  const horizontal = Math.sqrt(1 - z * z)
  return new Vector3(horizontal * Math.cos(angle), horizontal * Math.sin(angle), z)
})

/** Powers of ten spread evenly. */
export const magnitude = (min: number, max: number): fc.Arbitrary<number> =>
  number(Math.log(min), Math.log(max)).map(Math.exp)
