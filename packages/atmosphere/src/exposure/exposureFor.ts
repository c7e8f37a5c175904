import type { Camera } from 'three'
import { Vector3 } from 'three'
import { checkNonNegative, checkOptions, checkPositive } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { checkCamera } from '../check'
import { clampCosine } from '../AtmosphereQuery'
import { sampleDiffuseLight } from '../diffuseLight/cpu/diffuseLight'
import { sunTransmittance } from '../transmittance/cpu/transmittance'
import { almanacIlluminance, NIGHT_ILLUMINANCE } from '../night/cpu/twilight'
import { checkSources, type LightSource } from '../view/LightSource'
import { luminanceOf } from '../parameters/photometry'
import { checkAtmosphere } from '../view/ViewNodes'

/** Options of {@link exposureFor}. */
export interface ExposureOptions {
  /** Sources of light besides the sun, such as a moon's. */
  sources?: readonly LightSource[]
  /** Illuminance that is always there: the night sky's, a city's; > 0 [lx]. */
  floor?: number
}

/** Reflectance of what is looked at. */
const REFLECTANCE = 0.2

/** Illuminance that exposure 1 is for: full daylight [lx]. */
const DAYLIGHT = 1e5

/** Luminance under which the eye sees with its rods, and ever less [cd/m²]. */
const SCOTOPIC = 0.01

/** Power of luminance by which pictures darken there. */
const SCOTOPIC_POWER = 0.3

/** Illuminance by the bare sun above the Earth's air [lx]. */
const SUN_ILLUMINANCE = 132_000

const _direction = new Vector3()

/**
 * How bright a picture of a scene of some luminance should be: what the eye makes of it, once used to it.
 *
 * @see Krawczyk, Myszkowski & Seidel 2005, "Lightness perception in tone reproduction", eq. 11: the key
 *   falls from 0.7 in daylight to 0.03 where only rods see. Below 0.01 cd/m² the power of 0.3 is ours:
 *   a moonless night stays darker than one with a moon.
 */
function keyOf(luminance: number): number {
  const key = 1.03 - 2 / (2 + Math.log10(luminance + 1))
  return key * (luminance / (luminance + SCOTOPIC)) ** SCOTOPIC_POWER
}

/**
 * Exposure that suits an illuminance, falling steadily with it: 1 in full daylight (100 klx), 17,000 in
 * the light of a full moon, 1.1 million in a moonless night.
 *
 * @param illuminance - Of level ground, ≥ 0 [lx].
 * @throws If it is out of range.
 */
export function exposureOfIlluminance(illuminance: number): number {
  checkNonNegative('exposureOfIlluminance', 'illuminance', illuminance)
  const exposure = (lux: number): number => {
    const luminance = (lux * REFLECTANCE) / Math.PI
    return keyOf(luminance) / luminance
  }
  return exposure(Math.max(illuminance, 1e-9)) / exposure(DAYLIGHT)
}

/** @throws If an option is of the wrong kind or out of range. */
export function checkExposure(where: string, options: ExposureOptions = {}): ExposureOptions {
  const { sources = [], floor = NIGHT_ILLUMINANCE } = checkOptions(
    where,
    options,
    'sources',
    'floor'
  )
  checkSources(where, sources)
  checkPositive(where, 'floor', floor)
  return options
}

/** Illuminance of level ground by a source at a zenith angle [lx]. */
function groundIlluminance(
  atmosphere: Atmosphere,
  source: LightSource,
  position: Vector3,
  cosSun: number
): number {
  const { parameters, tables } = atmosphere
  const irradiance = source.irradianceAt(position)
  if (tables.data === null) {
    const elevation = Math.asin(clampCosine(cosSun)) * (180 / Math.PI)
    const bySun = almanacIlluminance(elevation) - almanacIlluminance(-90)
    return bySun * (luminanceOf(parameters, irradiance) / SUN_ILLUMINANCE)
  }
  const direct = sunTransmittance(parameters, parameters.bottomRadius, cosSun)
  const diffuse = sampleDiffuseLight(tables.data, 0, cosSun)[6]
  const values = irradiance.map(
    (value, i) => value * (direct[i] * Math.max(cosSun, 0) + Math.max(diffuse[i], 0))
  )
  return Math.max(luminanceOf(parameters, values), 0)
}

/**
 * Exposure for what a camera sees, day and night: a factor on daylight's that follows sun, moon and the
 * camera's place without a jump.
 *
 * ```ts
 * atmosphere.luminanceScale = 1e-4 * exposureFor(atmosphere, camera)
 * ```
 *
 * Put it into `luminanceScale` rather than `toneMappingExposure`: a night's luminance times 1e-4 is too
 * small a number for the half-float buffers that pictures are drawn to. What else shines in the scene
 * (emissive materials, lamps) must follow `luminanceScale` too.
 *
 * From the illuminance E of level ground, the scene's luminance L = 0.2 E/π gives the exposure key(L)/L.
 * It does not bring all scenes to one brightness: dusk is darker than day, and a moonless night darker
 * than one with a moon. The ground under the camera counts; from high up, ground that is nearer to the
 * source by half of the angle to the horizon. Until the tables have been read back, the almanac's
 * illuminance for the Earth stands in. Where the camera looks does not count.
 *
 * @param camera - Its `matrixWorld` must be up to date.
 * @returns Greater than 0; 1 in full daylight.
 * @throws If an argument is of the wrong kind or out of range.
 */
export function exposureFor(
  atmosphere: Atmosphere,
  camera: Camera,
  options: ExposureOptions = {}
): number {
  checkAtmosphere('exposureFor', atmosphere)
  checkCamera('exposureFor', camera)
  const { sources = [], floor = NIGHT_ILLUMINANCE } = checkExposure('exposureFor', options)
  const { space, parameters } = atmosphere
  const position = new Vector3().setFromMatrixPosition(camera.matrixWorld)
  const up = space.position(position, new Vector3())
  const radius = Math.max(up.length(), parameters.bottomRadius)
  up.normalize()
  const reach = Math.acos(parameters.bottomRadius / radius) / 2
  const illuminances = [atmosphere.sun, ...sources].map(source => {
    const direction = space.direction(source.direction(_direction, position), new Vector3())
    const zenithAngle = Math.acos(clampCosine(up.dot(direction)))
    const cosSun = Math.cos(Math.max(zenithAngle - reach, 0))
    return groundIlluminance(atmosphere, source, position, cosSun)
  })
  return exposureOfIlluminance(illuminances.reduce((sum, value) => sum + value, floor))
}
