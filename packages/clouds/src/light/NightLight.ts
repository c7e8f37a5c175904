import { NIGHT_ILLUMINANCE, scaleToLuminance } from '@welkin/atmosphere'
import type { AtmosphereView, LightSource } from '@welkin/atmosphere'
import { MathUtils, Vector3 } from 'three'
import { number, vector3, vector4 } from '../uniforms'

/** Greatest altitude of clouds [m]. */
const HIGHEST = 30_000

/**
 * Depression of the sun at which moonlight sets in, where the sun's own light reaches no cloud any more, and
 * how much deeper it is when all of the moonlight counts: before, twilight outshines it [rad]. Earlier: a
 * full moon shows at dusk; later: clouds are black for a while (*Cirrus*, a later "Hour").
 */
const NIGHTFALL = MathUtils.degToRad(6)
const DUSK = MathUtils.degToRad(2)

/**
 * Orders of magnitude by which light is raised in deep night, for half floats, and the sine of the sun's
 * depression there. Fewer: steps of grey in dark clouds (*24 hours*).
 */
const NIGHT_ORDERS = 5
const NIGHT_SINE = 0.3

/** Dip of the horizon below the level, seen from an altitude over a sphere [rad]. */
const dip = (radius: number, altitude: number): number =>
  Math.acos(radius / (radius + Math.max(altitude, 0)))

/** Elevation of the sun over the level [rad]. */
const sunElevation = ({ up, lightDirection }: AtmosphereView): number =>
  Math.asin(MathUtils.clamp(up.dot(lightDirection), -1, 1))

/**
 * Gain of stored light, so that half floats hold that of nights as well.
 *
 * @param radius - The planet's [m].
 */
export function nightGain(view: AtmosphereView, radius: number): number {
  // From high up one sees places where the sun is that much less deep.
  const depression = -sunElevation(view) - dip(radius, view.height)
  return 10 ** (NIGHT_ORDERS * MathUtils.clamp(Math.sin(depression) / NIGHT_SINE, 0, 1))
}

const _position = new Vector3()
const _direction = new Vector3()

/**
 * Light of clouds by night: the moon that was added to the atmosphere, and an even sky of stars and airglow.
 * Where the sun is up, none of it is computed.
 */
export class NightLight {
  /** 1 while clouds may be seen where the sun has set, else 0. */
  readonly isVisible = number()
  /** Sines of the sun's height below which moonlight sets in, and below which all of it counts. */
  readonly nightfall = number(-1)
  readonly deepNight = number(-1)
  /** Direction to the moon, in the mapped space. */
  readonly moonDirection = vector3()
  /** Irradiance of the moon above the air, over `solarIrradiance`; 0 without a moon. */
  readonly moonIrradiance = vector4()
  /** Mean radiance of the night sky, over `solarIrradiance` [1/sr]. */
  readonly skyRadiance = vector4()
  /** Illuminance of level ground by the night sky [lx]. */
  illuminance = NIGHT_ILLUMINANCE
  /** The moon; null if there is none. */
  source: LightSource | null = null

  constructor() {
    this.moonDirection.value.set(0, 0, 1)
  }

  /** Follows the camera and the moon. */
  update(view: AtmosphereView): void {
    const { atmosphere, camera, height } = view
    const { bottomRadius, sunAngularRadius } = atmosphere.parameters
    const cloudDip = dip(bottomRadius, HIGHEST)
    const nightfall = Math.max(NIGHTFALL, cloudDip + 1.1 * sunAngularRadius)
    this.nightfall.value = -Math.sin(nightfall)
    this.deepNight.value = -Math.sin(nightfall + DUSK)
    // As far as clouds can be seen, the sun is at most that much lower than at the camera.
    const lowest = sunElevation(view) - dip(bottomRadius, height) - cloudDip
    this.isVisible.value = lowest < -nightfall ? 1 : 0
    this.source = atmosphere.layers.find(layer => layer.source !== undefined)?.source ?? null
    this.moonIrradiance.value.setScalar(0)
    if (this.isVisible.value === 0) return
    _position.setFromMatrixPosition(camera.matrixWorld)
    if (this.source !== null) {
      this.moonIrradiance.value.fromArray(this.source.irradianceAt(_position))
      this.source.direction(_direction, _position)
      atmosphere.space.direction(_direction, this.moonDirection.value)
    }
    const values = scaleToLuminance(atmosphere.parameters, [1, 1, 1, 1], this.illuminance / Math.PI)
    this.skyRadiance.value.fromArray(values)
  }

  /** True if the moon lights the clouds where the camera is. */
  isMoonlitAt({ up, lightDirection }: AtmosphereView): boolean {
    const isNight = this.isVisible.value === 1 && up.dot(lightDirection) < this.nightfall.value
    return isNight && this.moonIrradiance.value.y > 0
  }
}
