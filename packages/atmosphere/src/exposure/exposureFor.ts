import type { Camera } from 'three'
import { Vector3 } from 'three'
import { checkNonNegative, checkOptions, checkPositive } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { checkCamera } from '../check'
import { checkCloudedSky, type CloudedPoint, type CloudedSky } from '../queries/CloudedSky'
import { clampCosine } from '../queries/LightQuery'
import { sampleDiffuseLight } from '../diffuseLight/cpu/diffuseLight'
import { lightTransmittance } from '../transmittance/cpu/transmittance'
import { almanacIlluminance, NIGHT_ILLUMINANCE } from '../night/cpu/twilight'
import { checkSources, type LightSource } from '../view/LightSource'
import type { AtmosphereParameters } from '../parameters/AtmosphereParameters'
import { luminanceOf, scaleToLuminance } from '../parameters/photometry'
import { keyValue } from './cpu/keyValue'
import { checkAtmosphere } from '../view/ViewNodes'

/** Options of {@link exposureFor}. */
export interface ExposureOptions {
  /** Light sources besides the sun, such as a moon's; by default none. */
  sources?: readonly LightSource[]
  /** Illuminance that is always present, of the night sky or a city, and under clouds too; > 0 [lx]. By default the night sky's. */
  floor?: number
  /** Clouds in the sky, in the mean over clouds and gaps: a `CloudCover` of `@welkin/clouds`. By default none. */
  clouds?: CloudedSky | null
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
  const { sources = [], floor, clouds } = checkOptions(where, options, 'sources', 'floor', 'clouds')
  checkSources(where, sources)
  if (floor !== undefined) checkPositive(where, 'floor', floor)
  checkCloudedSky(where, clouds)
  return options
}

/** Position [world] whose ground is lit, and the clouds over it. */
interface Ground {
  readonly position: Vector3
  /** Altitude of the position, whose clouds count [m]. */
  readonly altitude: number
  readonly clouds: CloudedSky | null
}

/** Illuminance of level ground by a light source [lx]. */
function groundIlluminance(
  atmosphere: Atmosphere,
  source: LightSource,
  ground: Ground,
  cosLight: number
): number {
  const { parameters, tables } = atmosphere
  const { data } = tables
  const { bottomRadius, topRadius } = parameters
  const irradiance = source.irradianceAt(ground.position)
  const facing = Math.max(cosLight, 0)
  const direct = (altitude: number): number[] =>
    lightTransmittance(parameters, bottomRadius + altitude, cosLight).map(value => value * facing)
  if (data !== null) {
    const part = 1 / (topRadius - bottomRadius)
    const diffuse = (altitude: number): { up: number[]; down: number[] } => {
      const [up, down] = sampleDiffuseLight(data, altitude * part, cosLight)
        .slice(6)
        .map(values => values.map(value => Math.max(value, 0)))
      return { up, down }
    }
    return illuminanceOf(parameters, ground, { cosLight, direct, diffuse, irradiance })
  }
  const elevation = Math.asin(clampCosine(cosLight)) * (180 / Math.PI)
  const bySun = almanacIlluminance(elevation) - almanacIlluminance(-90)
  const part = luminanceOf(parameters, irradiance) / SUN_ILLUMINANCE
  if (ground.clouds === null) return bySun * part
  const onGround = direct(0)
  const bySky = Math.max(bySun - luminanceOf(parameters, onGround), 0)
  const diffuse = diffuseOverGround(parameters, bySky, onGround)
  return part * illuminanceOf(parameters, ground, { cosLight, direct, diffuse })
}

/** Diffuse light of the spectrum of sunlight, the same at all altitudes, over ground that reflects it. */
function diffuseOverGround(
  parameters: AtmosphereParameters,
  illuminance: number,
  direct: readonly number[]
): CloudedPoint['diffuse'] {
  const up = scaleToLuminance(parameters, [1, 1, 1, 1], illuminance)
  const down = parameters.groundAlbedo.map((albedo, i) => albedo * (direct[i] + up[i]))
  return () => ({ up, down })
}

/** Light without clouds, for unit irradiance of its source. */
interface ClearLight extends Pick<CloudedPoint, 'cosLight' | 'direct' | 'diffuse'> {
  /** Irradiance of the source, over `solarIrradiance`; left out, 1. */
  readonly irradiance?: readonly number[]
}

/** Illuminance of level ground in a source's light, under clouds if there are some [lx]. */
function illuminanceOf(
  parameters: AtmosphereParameters,
  { position, altitude, clouds }: Ground,
  { cosLight, direct, diffuse, irradiance = [1, 1, 1, 1] }: ClearLight
): number {
  const { groundAlbedo } = parameters
  const point = { position, altitude, cosLight, groundAlbedo, direct, diffuse }
  const [sun, clear] = [direct(0), diffuse(0).up]
  const beam = clouds?.beam(point) ?? 1
  const sky = clouds?.irradiance(point, 1, clear) ?? clear
  const values = irradiance.map((value, i) => value * (sun[i] * beam + sky[i]))
  return Math.max(luminanceOf(parameters, values), 0)
}

/** Illuminance of level ground by the night sky [lx]. */
function nightIlluminance(parameters: AtmosphereParameters, ground: Ground): number {
  if (ground.clouds === null) return NIGHT_ILLUMINANCE
  const none = [0, 0, 0, 0]
  const diffuse = diffuseOverGround(parameters, NIGHT_ILLUMINANCE, none)
  return illuminanceOf(parameters, ground, { cosLight: 1, direct: () => none, diffuse })
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
 * illuminance for the Earth stands in. Where the camera looks does not count. With clouds, the ground's light is
 * dimmed by those above the camera: under an overcast it is that of the overcast, from above the clouds nothing changes.
 *
 * @param camera - Camera, whose `matrixWorld` must be up to date.
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
  const { sources = [], floor, clouds = null } = checkExposure('exposureFor', options)
  const { space, parameters } = atmosphere
  const position = new Vector3().setFromMatrixPosition(camera.matrixWorld)
  const up = space.position(position, new Vector3())
  const radius = Math.max(up.length(), parameters.bottomRadius)
  up.normalize()
  const ground = { position, altitude: radius - parameters.bottomRadius, clouds }
  const halfHorizon = Math.acos(parameters.bottomRadius / radius) / 2
  const illuminances = [atmosphere.sun, ...sources].map(source => {
    const direction = space.direction(source.direction(_direction, position), new Vector3())
    const zenithAngle = Math.acos(clampCosine(up.dot(direction)))
    const cosLight = Math.cos(Math.max(zenithAngle - halfHorizon, 0))
    return groundIlluminance(atmosphere, source, ground, cosLight)
  })
  const night = floor ?? nightIlluminance(parameters, ground)
  return exposureOfIlluminance(illuminances.reduce((sum, value) => sum + value, night))
}
