import type { Quaternion } from 'three'
import { Vector3 } from 'three'
import type { CloudWind } from './CloudLayer'

const _east = new Vector3()
const _north = new Vector3()

/**
 * How far wind turns a shell of air about the planet's centre, seen from the shell: what is looked up
 * at p after a time was at `target · p` before.
 *
 * @param up - Zenith where the wind blows as given; at a pole, east is that of longitude 0.
 * @param seconds - Time [s].
 * @param radius - Of the shell [m].
 */
export function windRotation(
  wind: CloudWind,
  up: Vector3,
  seconds: number,
  radius: number,
  target: Quaternion
): Quaternion {
  const speed = Math.hypot(wind.east, wind.north)
  if (!(speed > 0)) return target.identity()
  _east.set(-up.y, up.x, 0)
  if (_east.lengthSq() < 1e-20) _east.set(0, 1, 0)
  _north.crossVectors(up, _east.normalize())
  const axis = _north.multiplyScalar(wind.east).addScaledVector(_east, -wind.north)
  // Whole turns say nothing, and a sine of 1e15 neither.
  const angle = ((speed * seconds) / radius) % (2 * Math.PI)
  return target.setFromAxisAngle(axis.divideScalar(speed), -angle)
}
