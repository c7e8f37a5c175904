import { Ellipsoid } from '@welkin/geo'
import { Matrix4, type Vector3 } from 'three'
import type { HeightSource } from '../src/heights/HeightSource'

/** Radius of the ball [m]. */
export const RADIUS = 6.371e6
const sphere = new Ellipsoid(RADIUS)
const none = (): never => {
  throw new Error('not drawn here')
}

/** Ground on a ball, from a function of the direction from its centre. */
export function groundOf(
  heightOf: (direction: Vector3) => number,
  [lowest, highest]: [number, number],
  slope: number
) {
  const source: HeightSource = {
    lowest,
    highest,
    variation: distance => Math.min(slope * distance, highest - lowest),
    sampleAt(position, target) {
      target.height = heightOf(position.clone().normalize())
      return target
    },
    sample: none
  }
  const atmosphere = { ellipsoid: sphere, worldToECEF: new Matrix4() }
  return { atmosphere, source, seaLevel: -Infinity }
}
