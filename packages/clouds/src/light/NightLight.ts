import { NIGHT_ILLUMINANCE, scaleToLuminance } from '@welkin/atmosphere'
import type { AtmosphereView, LightSource } from '@welkin/atmosphere'
import { MathUtils, Vector3 } from 'three'
import { number, vector3, vector4 } from '../uniforms'

/** Altitude above which there are no clouds [m]. */
const HIGHEST = 30_000

/**
 * Depression of the sun at which moonlight sets in on Earth, where its own light reaches no cloud any
 * more, and how much deeper it is when all of it counts: twilight is that much brighter before [rad].
 */
const SUNK = MathUtils.degToRad(6)
const DUSK = MathUtils.degToRad(2)

/** Orders of magnitude by which light is raised in deep night, and the sine of the sun's depression there. */
const NIGHT_ORDERS = 5
const NIGHT_SINE = 0.3

/** How far below the level the horizon is from an altitude, on a sphere [rad]. */
const dip = (radius: number, altitude: number): number =>
  Math.acos(radius / (radius + Math.max(altitude, 0)))

/** Height of the sun over the level [rad]. */
const sunHeight = ({ up, sunDirection }: AtmosphereView): number =>
  Math.asin(MathUtils.clamp(up.dot(sunDirection), -1, 1))

/**
 * What light is multiplied with for half floats to hold that of nights as well.
 *
 * @param radius - Of the planet [m].
 */
export function nightGain(view: AtmosphereView, radius: number): number {
  // From high up one sees places where the sun is that much less deep.
  const depression = -sunHeight(view) - dip(radius, view.height)
  return 10 ** (NIGHT_ORDERS * MathUtils.clamp(Math.sin(depression) / NIGHT_SINE, 0, 1))
}

const _position = new Vector3()
const _direction = new Vector3()

/**
 * What lights clouds when the sun has set: the moon that was added to the atmosphere, and an even sky of
 * stars and airglow. Where the sun is up, nothing of it is computed.
 */
export class NightLight {
  /** 1 while clouds may be seen where the sun has set, else 0. */
  readonly isSeen = number()
  /** Sines of the sun's height below which moonlight sets in, and below which all of it counts. */
  readonly sunk = number(-1)
  readonly dark = number(-1)
  /** To the moon, in the mapped space. */
  readonly direction = vector3(0, 0, 1)
  /** Of the moon above the air, over `solarIrradiance`; 0 without a moon. */
  readonly irradiance = vector4()
  /** Mean radiance of the night sky, over `solarIrradiance` [1/sr]. */
  readonly radiance = vector4()
  /** Of level ground by the night sky [lx]. */
  illuminance = NIGHT_ILLUMINANCE
  /** The moon; null if there is none. */
  source: LightSource | null = null

  /** Follows the camera and the moon. */
  update(view: AtmosphereView): void {
    const { atmosphere, camera, height } = view
    const { bottomRadius, sunAngularRadius } = atmosphere.parameters
    const reach = dip(bottomRadius, HIGHEST)
    const sunk = Math.max(SUNK, reach + 1.1 * sunAngularRadius)
    this.sunk.value = -Math.sin(sunk)
    this.dark.value = -Math.sin(sunk + DUSK)
    // As far as clouds can be seen, the sun is at most that much lower than at the camera.
    const lowest = sunHeight(view) - dip(bottomRadius, height) - reach
    this.isSeen.value = lowest < -sunk ? 1 : 0
    this.source = atmosphere.layers.find(layer => layer.source !== undefined)?.source ?? null
    this.irradiance.value.setScalar(0)
    if (this.isSeen.value === 0) return
    _position.setFromMatrixPosition(camera.matrixWorld)
    if (this.source !== null) {
      this.irradiance.value.fromArray(this.source.irradianceAt(_position))
      this.source.direction(_direction, _position)
      atmosphere.space.direction(_direction, this.direction.value)
    }
    const values = scaleToLuminance(atmosphere.parameters, [1, 1, 1, 1], this.illuminance / Math.PI)
    this.radiance.value.fromArray(values)
  }

  /** Whether the camera is where the moon lights the clouds. */
  rulesAt({ up, sunDirection }: AtmosphereView): boolean {
    const isNight = this.isSeen.value === 1 && up.dot(sunDirection) < this.sunk.value
    return isNight && this.irradiance.value.y > 0
  }
}
