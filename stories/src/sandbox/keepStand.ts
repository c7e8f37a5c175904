import { Quaternion, Vector3 } from 'three'
import type { Object3D } from 'three'

/** Farthest from the top of a planet that one is taken to by keeping one's way to it, as an angle at its middle [rad]. */
const FARTHEST = 0.5

const outwards = new Vector3()
const axis = new Vector3()
const turn = new Quaternion()

/**
 * Keeps where a camera stands when its planet becomes one of another radius: height above the ground, direction of view
 * against the ground, and way along the ground to the top of the planet, which is the world's origin.
 *
 * @param radius - Radius that the planet had, and `next` that it has [m].
 */
export function keepStand(camera: Object3D, radius: number, next: number): void {
  const { position, quaternion } = camera
  const aside = Math.hypot(position.x, position.z)
  const height = Math.hypot(aside, position.y + radius) - radius
  const before = Math.atan2(aside, position.y + radius)
  // From afar on a large planet the way would lead around a small one.
  const after = Math.min((before * radius) / next, Math.max(before, FARTHEST))
  if (aside > 0) {
    outwards.set(position.x / aside, 0, position.z / aside)
    axis.set(outwards.z, 0, -outwards.x)
    quaternion.premultiply(turn.setFromAxisAngle(axis, after - before))
  }
  const fromMiddle = next + height
  position.copy(outwards.multiplyScalar(aside > 0 ? fromMiddle * Math.sin(after) : 0))
  // Without the difference of two large numbers.
  position.y = height * Math.cos(after) - 2 * next * Math.sin(after / 2) ** 2
  camera.updateMatrixWorld()
}
