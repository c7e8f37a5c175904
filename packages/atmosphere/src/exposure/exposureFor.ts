import type { Camera } from 'three'
import { Vector3 } from 'three'
import { checkNonNegative, checkOptions, checkPositive } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { checkCamera } from '../check'
import { clampCosine } from '../queries/LightQuery'
import { sampleDiffuseLight } from '../diffuseLight/cpu/diffuseLight'
import { lightTransmittance } from '../transmittance/cpu/transmittance'
import { almanacIlluminance, NIGHT_ILLUMINANCE } from '../night/cpu/twilight'
import { checkSources, type LightSource } from '../view/LightSource'
import { luminanceOf } from '../parameters/photometry'
import { keyValue } from './cpu/keyValue'
import { checkAtmosphere } from '../view/ViewNodes'

/** Options of {@link exposureFor}. */
export interface ExposureOptions {
  /** Light sources besides the sun, such as a moon's. */
  sources?: readonly LightSource[]
  /** Illuminance that is always present, of the night sky or a city; > 0 [lx]. */
  floor?: number
}

/** Mean reflectance of a scene. */
const SCENE_REFLECTANCE = 0.2

/** Illuminance of exposure 1: full daylight [lx]. */
const DAYLIGHT_ILLUMINANCE = 1e5

/** Illuminance by the bare sun above the Earth's air [lx]. */
const SUN_ILLUMINANCE = 132_000

const _direction = new Vector3()

/**
 * Exposure for an illuminance, falling steadily with it: 1 in full daylight (100 klx), 17,000 by the light
 * of a full moon, 1.1 million on a moonless night.
 *
 * @param illuminance - Illuminance of level ground, ≥ 0 [lx].
 * @throws If it is out of range.
 */
export function exposureOfIlluminance(illuminance: number): number {
  checkNonNegative('exposureOfIlluminance', 'illuminance', illuminance)
  const exposure = (lux: number): number => {
    const luminance = (lux * SCENE_REFLECTANCE) / Math.PI
    return keyValue(luminance) / luminance
  }
  return exposure(Math.max(illuminance, 1e-9)) / exposure(DAYLIGHT_ILLUMINANCE)
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

/** Illuminance of level ground by a light source [lx]. */
function groundIlluminance(
  atmosphere: Atmosphere,
  source: LightSource,
  position: Vector3,
  cosLight: number
): number {
  const { parameters, tables } = atmosphere
  const irradiance = source.irradianceAt(position)
  if (tables.data === null) {
    const elevation = Math.asin(clampCosine(cosLight)) * (180 / Math.PI)
    const bySun = almanacIlluminance(elevation) - almanacIlluminance(-90)
    return bySun * (luminanceOf(parameters, irradiance) / SUN_ILLUMINANCE)
  }
  const direct = lightTransmittance(parameters, parameters.bottomRadius, cosLight)
  const diffuse = sampleDiffuseLight(tables.data, 0, cosLight)[6]
  const values = irradiance.map(
    (value, i) => value * (direct[i] * Math.max(cosLight, 0) + Math.max(diffuse[i], 0))
  )
  return Math.max(luminanceOf(parameters, values), 0)
}

/**
 * Exposure for a camera, day and night: a factor on that of daylight, which follows sun, moon and the
 * camera's position continuously.
 *
 * ```ts
 * atmosphere.luminanceScale = 1e-4 * exposureFor(atmosphere, camera)
 * ```
 *
 * Put it into `luminanceScale` rather than `toneMappingExposure`: a night's luminance times 1e-4 is too
 * small for the half-float buffers that pictures are drawn to. Emissive materials and lamps in the scene
 * must follow `luminanceScale` too.
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
  const halfHorizon = Math.acos(parameters.bottomRadius / radius) / 2
  const illuminances = [atmosphere.sun, ...sources].map(source => {
    const direction = space.direction(source.direction(_direction, position), new Vector3())
    const zenithAngle = Math.acos(clampCosine(up.dot(direction)))
    const cosLight = Math.cos(Math.max(zenithAngle - halfHorizon, 0))
    return groundIlluminance(atmosphere, source, position, cosLight)
  })
  return exposureOfIlluminance(illuminances.reduce((sum, value) => sum + value, floor))
}
