import type { Vector3 } from 'three'
import { checkOptions } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import type { Triple } from '../air/cpu/color'
import { skyRadiance } from '../scattering/cpu/scattering'
import type { LightSource } from '../view/LightSource'
import { LightQuery } from './LightQuery'

/** Options of {@link skyLuminanceAt}. */
export interface SkyLuminanceOptions {
  /** Source of the light in the sky; by default the sun. A moon's is `moon.source`. */
  source?: LightSource
}

/**
 * Luminance of the sky, or of the model's ground, in a direction, by a float64 march; without the
 * sun's disc. Takes about a millisecond.
 *
 * @param position - World.
 * @param direction - World, any length.
 * @returns Linear sRGB [cd/m²].
 * @throws Before the tables were baked and read back: await `atmosphere.bake(renderer)` first.
 */
export function skyLuminanceAt(
  atmosphere: Atmosphere,
  position: Vector3,
  direction: Vector3,
  options: SkyLuminanceOptions = {}
): Triple {
  const { source } = checkOptions('skyLuminanceAt', options, 'source')
  const query = new LightQuery('skyLuminanceAt', atmosphere, position, source)
  const { parameters, data, radius, cosLight } = query
  const { zenith, light } = query.cosinesOf('direction', direction)
  const ray = { radius, cosView: zenith, cosLight, cosViewLight: light }
  return query.linearSRGB(skyRadiance(parameters, data, ray))
}
