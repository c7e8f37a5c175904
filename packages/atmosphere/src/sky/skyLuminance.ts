import type { Vector3 } from 'three'
import type { Atmosphere } from '../Atmosphere'
import { checkAtmosphere } from '../view/ViewNodes'
import { clampCosine } from '../AtmosphereQuery'
import type { Triple } from '../air/cpu/color'
import { skyRadiance } from '../scattering/cpu/scattering'

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
  direction: Vector3
): Triple {
  checkAtmosphere('skyLuminanceAt', atmosphere)
  const query = atmosphere.query(position)
  const data = query.table('skyLuminanceAt')
  const { up, radius, cosLight } = query.place(position)
  const v = query.direction('direction', direction)
  const ray = {
    radius,
    cosView: clampCosine(v.dot(up)),
    cosLight,
    cosViewLight: clampCosine(v.dot(query.lightDirection))
  }
  return query.linearSRGB(skyRadiance(query.parameters, data, ray))
}
