import { Vector3 } from 'three'
import type { DirectionalLight, Light, PointLight } from 'three'
import type { Atmosphere } from '../Atmosphere'
import { sunWhite } from '../ground/cpu/reflectance'
import type { AtmosphereParameters } from '../parameters/AtmosphereParameters'

/** Source of a shell's light. */
export type ShellSun = Atmosphere | DirectionalLight | PointLight | Vector3

/** Scale that the colour matrix of a shell is computed with; its tint makes up for any other. */
export const SHELL_SCALE = 1e-4

const _target = new Vector3()

export const isAtmosphere = (sun: ShellSun): sun is Atmosphere => 'isAtmosphere' in sun
const isLight = (sun: ShellSun): sun is DirectionalLight | PointLight =>
  'isDirectionalLight' in sun || 'isPointLight' in sun

/** Type guard of {@link ShellSun} for values of any type; a direction must be finite and not zero. */
export function isShellSun(sun: ShellSun | null): boolean {
  if (typeof sun !== 'object' || sun === null) return false
  if (isAtmosphere(sun) || isLight(sun)) return true
  if (!('isVector3' in sun)) return false
  const length = sun.manhattanLength()
  return length > 0 && length < Infinity
}

/** Factors of linear sRGB that give sunlight the colour and brightness of a light, per {@link SHELL_SCALE}. */
function lightTint(light: Light, parameters: AtmosphereParameters, tint: Vector3): Vector3 {
  const { color, intensity } = light
  const white = sunWhite(parameters)
  tint.set(color.r / white[0], color.g / white[1], color.b / white[2])
  return tint.multiplyScalar(intensity / SHELL_SCALE)
}

/**
 * Direction to a sun, and its tint.
 *
 * @param bodyWorld - Position of the body.
 * @param luminanceScale - Output per luminance where the sun is a direction.
 * @param directionWorld - Written: direction to the sun, of any length.
 * @param tint - Written: factors of linear sRGB.
 */
export function sunlightAt(
  sun: ShellSun,
  parameters: AtmosphereParameters,
  bodyWorld: Vector3,
  luminanceScale: number,
  directionWorld: Vector3,
  tint: Vector3
): void {
  if (isAtmosphere(sun)) {
    directionWorld.copy(sun.sunDirection)
    tint.setScalar(sun.luminanceScale / SHELL_SCALE)
  } else if (isLight(sun)) {
    directionWorld.setFromMatrixPosition(sun.matrixWorld)
    lightTint(sun, parameters, tint)
    if ('target' in sun) {
      directionWorld.sub(_target.setFromMatrixPosition(sun.target.matrixWorld))
    } else {
      directionWorld.sub(bodyWorld)
      tint.divideScalar(directionWorld.lengthSq() || 1)
    }
  } else {
    directionWorld.copy(sun)
    tint.setScalar(luminanceScale / SHELL_SCALE)
  }
}
