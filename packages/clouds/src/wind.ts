import type { Quaternion } from 'three'
import { Vector3 } from 'three'
import type { CloudWind } from './CloudLayer'

const _east = new Vector3()
const _north = new Vector3()

/** East, unit length; at a pole that of longitude 0. */
export function eastAt(up: Vector3, target: Vector3): Vector3 {
  target.set(-up.y, up.x, 0)
  if (target.lengthSq() < 1e-20) target.set(0, 1, 0)
  return target.normalize()
}

/**
 * How far wind turns a shell of air about the planet's centre, seen from the shell: what is looked up
 * at p after a time was at `target · p` before.
 *
 * @param up - Zenith where the wind blows as given.
 * @param seconds - Time [s].
 * @param radius - Of the shell [m].
 */
export function windTurn(
  wind: CloudWind,
  up: Vector3,
  seconds: number,
  radius: number,
  target: Quaternion
): Quaternion {
  const speed = Math.hypot(wind.east, wind.north)
  if (!(speed > 0)) return target.identity()
  _north.crossVectors(up, eastAt(up, _east))
  const axis = _north.multiplyScalar(wind.east).addScaledVector(_east, -wind.north)
  // Whole turns say nothing, and a sine of 1e15 neither.
  const angle = ((speed * seconds) / radius) % (2 * Math.PI)
  return target.setFromAxisAngle(axis.divideScalar(speed), -angle)
}
