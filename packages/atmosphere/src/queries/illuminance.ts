import type { Vector3 } from 'three'
import { fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import type { Triple } from '../air/cpu/color'
import { skyIrradiance } from '../diffuseLight/cpu/skyIrradiance'
import { Moon } from '../moon/Moon'
import { lightTransmittance } from '../transmittance/cpu/transmittance'
import type { LightSource } from '../view/LightSource'
import { LightQuery } from './LightQuery'

/** Illuminance on a plane that faces the source. */
function directIlluminance(query: LightQuery): Triple {
  const { parameters, radius, cosLight } = query
  return query.linearSRGB(lightTransmittance(parameters, radius, cosLight))
}

/**
 * Illuminance by the sun on a plane that faces it, reddened by the air and blocked by planet and moon.
 *
 * @param position - World.
 * @returns Linear sRGB [lx].
 */
export function sunIlluminanceAt(atmosphere: Atmosphere, position: Vector3): Triple {
  return directIlluminance(new LightQuery('sunIlluminanceAt', atmosphere, position))
}

/**
 * Illuminance by a moon on a plane that faces it, reddened by the air and blocked by the planet.
 *
 * @param moon - Must be in an atmosphere.
 * @param position - World.
 * @returns Linear sRGB [lx].
 */
export function moonIlluminanceAt(moon: Moon, position: Vector3): Triple {
  if (!(moon instanceof Moon)) fail('moonIlluminanceAt', 'moon must be a Moon', moon)
  const { atmosphere, source } = moon
  return directIlluminance(new LightQuery('moonIlluminanceAt', atmosphere, position, source))
}

/**
 * Illuminance by sky and ground on a plane.
 *
 * @param position - World.
 * @param normal - World, unit length: where the plane faces.
 * @param source - Whose light in the sky; by default the sun's. A moon's is `moon.source`.
 * @returns Linear sRGB [lx].
 * @throws Before the tables were baked and read back: await `atmosphere.bake(renderer)` first.
 */
export function skyIlluminanceAt(
  atmosphere: Atmosphere,
  position: Vector3,
  normal: Vector3,
  source?: LightSource
): Triple {
  const query = new LightQuery('skyIlluminanceAt', atmosphere, position, source)
  const { parameters, data, radius, cosLight } = query
  const { zenith, light } = query.cosinesOf('normal', normal)
  const altitude = radius - parameters.bottomRadius
  return query.linearSRGB(skyIrradiance(parameters, data, altitude, zenith, cosLight, light))
}
