import type { Vector3 } from 'three'
import { checkOptions, fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import type { Triple } from '../air/cpu/color'
import { skyIrradiance } from '../diffuseLight/cpu/skyIrradiance'
import { Moon } from '../moon/Moon'
import { lightTransmittance } from '../transmittance/cpu/transmittance'
import type { LightSource } from '../view/LightSource'
import { checkCloudedSky, type CloudedSky } from './CloudedSky'
import { LightQuery } from './LightQuery'

/** Options of {@link sunIlluminanceAt} and {@link moonIlluminanceAt}. */
export interface IlluminanceOptions {
  /** Clouds in the sky, in the mean over clouds and gaps: a `CloudCover` of `@welkin/clouds`. By default none. */
  clouds?: CloudedSky | null
}

/** Options of {@link skyIlluminanceAt}. */
export interface SkyIlluminanceOptions extends IlluminanceOptions {
  /** Source of the light in the sky; by default the sun. A moon's is `moon.source`. */
  source?: LightSource
}

/** Clouds of options that have no others. */
function cloudsOf(where: string, options: IlluminanceOptions): CloudedSky | null {
  const { clouds = null } = checkOptions(where, options, 'clouds')
  checkCloudedSky(where, clouds)
  return clouds
}

/** Illuminance on a plane that faces the source. */
function directIlluminance(query: LightQuery, clouds: CloudedSky | null): Triple {
  const { parameters, radius, cosLight } = query
  const passing = clouds?.beam(query) ?? 1
  const transmittance = lightTransmittance(parameters, radius, cosLight)
  return query.linearSRGB(transmittance.map(value => value * passing))
}

/**
 * Illuminance by the sun on a plane that faces it, reddened by the air and blocked by planet and moon.
 *
 * @param position - World.
 * @returns Linear sRGB [lx].
 * @throws If an argument is of the wrong kind.
 */
export function sunIlluminanceAt(
  atmosphere: Atmosphere,
  position: Vector3,
  options: IlluminanceOptions = {}
): Triple {
  const clouds = cloudsOf('sunIlluminanceAt', options)
  return directIlluminance(new LightQuery('sunIlluminanceAt', atmosphere, position), clouds)
}

/**
 * Illuminance by a moon on a plane that faces it, reddened by the air and blocked by the planet.
 *
 * @param moon - Must be in an atmosphere.
 * @param position - World.
 * @returns Linear sRGB [lx].
 * @throws If an argument is of the wrong kind.
 */
export function moonIlluminanceAt(
  moon: Moon,
  position: Vector3,
  options: IlluminanceOptions = {}
): Triple {
  if (!(moon instanceof Moon)) fail('moonIlluminanceAt', 'moon must be a Moon', moon)
  const clouds = cloudsOf('moonIlluminanceAt', options)
  const { atmosphere, source } = moon
  return directIlluminance(
    new LightQuery('moonIlluminanceAt', atmosphere, position, source),
    clouds
  )
}

/**
 * Illuminance by sky and ground on a plane; with clouds also by these, but without light that passes them
 * unscattered: `sunIlluminanceAt` has that.
 *
 * @param position - World.
 * @param normal - World, unit length: where the plane faces.
 * @returns Linear sRGB [lx].
 * @throws If an argument is of the wrong kind, and before the tables were baked and read back: await
 *   `atmosphere.bake(renderer)` first.
 */
export function skyIlluminanceAt(
  atmosphere: Atmosphere,
  position: Vector3,
  normal: Vector3,
  options: SkyIlluminanceOptions = {}
): Triple {
  const where = 'skyIlluminanceAt'
  const { source, clouds } = checkOptions(where, options, 'source', 'clouds')
  checkCloudedSky(where, clouds)
  const query = new LightQuery(where, atmosphere, position, source)
  const { parameters, data, altitude, cosLight } = query
  const { bottomRadius, groundAlbedo } = parameters
  const { zenith, light } = query.cosinesOf('normal', normal)
  const clear = skyIrradiance(parameters, data, altitude, zenith, cosLight, light)
  if (!clouds) return query.linearSRGB(clear)
  const point = {
    position,
    altitude,
    cosLight,
    groundAlbedo,
    direct: (height: number) =>
      lightTransmittance(parameters, bottomRadius + height, cosLight).map(
        value => value * Math.max(cosLight, 0)
      ),
    diffuse: (height: number) => {
      const facing = (cosNormal: 1 | -1): number[] =>
        skyIrradiance(parameters, data, height, cosNormal, cosLight, cosNormal * cosLight)
      return { up: facing(1), down: facing(-1) }
    }
  }
  return query.linearSRGB(clouds.irradiance(point, zenith, clear))
}
