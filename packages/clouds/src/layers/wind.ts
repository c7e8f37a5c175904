import type { Quaternion } from 'three'
import { Vector3 } from 'three'
import type { CloudWind } from './CloudLayer'

const _east = new Vector3()
const _axis = new Vector3()

/**
 * Axis about which wind turns a shell of air: air at the zenith `up` moves along `cross(axis, up)`.
 *
 * @param up - Zenith where the wind blows as given; at a pole, east is that of longitude 0.
 * @returns Direction of unit length; 0 in calm.
 */
export function windAxis({ east, north }: CloudWind, up: Vector3, target: Vector3): Vector3 {
  const speed = Math.hypot(east, north)
  if (!(speed > 0)) return target.set(0, 0, 0)
  _east.set(-up.y, up.x, 0)
  if (_east.lengthSq() < 1e-20) _east.set(0, 1, 0)
  target.crossVectors(up, _east.normalize())
  return target.multiplyScalar(east).addScaledVector(_east, -north).divideScalar(speed)
}

/**
 * Rotation of a shell of air about the planet's centre by wind, seen from the shell: the noise that is
 * looked up at p after a time was at `target · p` before.
 *
 * @param up - Zenith where the wind blows as given; at a pole, east is that of longitude 0.
 * @param seconds - Time [s].
 * @param radius - Radius of the shell [m].
 */
export function windRotation(
  wind: CloudWind,
  up: Vector3,
  seconds: number,
  radius: number,
  target: Quaternion
): Quaternion {
  const speed = Math.hypot(wind.east, wind.north)
  // Without whole turns: the sine of 1e15 has no digit left.
  const angle = ((speed * seconds) / radius) % (2 * Math.PI)
  return target.setFromAxisAngle(windAxis(wind, up, _axis), -angle)
}
