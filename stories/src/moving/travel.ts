import { Vector3 } from 'three'
import type { PerspectiveCamera } from 'three'
import type { Explorer } from './Explorer'

/** Time of a flight between views of a story [s]. */
export const FLIGHT_SECONDS = 4
/** Time of a turn, or of a flight that follows a slider [s]. */
export const TURN_SECONDS = 1.5

/**
 * Takes a camera to where something puts it: in a flight, or at once where nobody moves it.
 *
 * @param explorer - Explorer of the camera; undefined in a still.
 * @param place - Moves and turns the camera that it is given.
 */
export function travel(
  explorer: Explorer | undefined,
  camera: PerspectiveCamera,
  place: (camera: PerspectiveCamera) => void,
  seconds: number
): void {
  const aim = explorer === undefined ? camera : camera.clone()
  place(aim)
  aim.updateMatrixWorld()
  const direction = aim.getWorldDirection(new Vector3())
  void explorer?.flyTo({ position: aim.position, direction }, seconds)
}
