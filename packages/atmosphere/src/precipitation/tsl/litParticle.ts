import { vec3 } from 'three/tsl'
import type { Float, Vec3 } from '../../tsl-types'
import type { LampUniforms } from '../LampUniforms'
import type { MeasuredLight } from '../MeasuredLight'
import type { ParticleKind } from '../ParticleKind'
import { particlePhase } from './particlePhase'

/**
 * Luminance of a particle, in the unit of three's lights.
 *
 * It scatters light of lamps and sun by its phase function. Of sky and ground it shows the mean of what lies behind it, as a drop refracts
 * light from a field of view of 165° (Garg & Nayar 2007, "Vision and rain", §3), and an even part of the light from all sides.
 *
 * @param direction - View direction in the lattice's frame.
 * @param place - Its place in view space [world units].
 */
export function litParticle(
  { phase: [concentration, even] }: ParticleKind,
  measured: MeasuredLight,
  lamps: readonly LampUniforms[],
  sizeClass: Float,
  direction: Vec3,
  place: Vec3
): Vec3 {
  const behind = measured.radianceAround(direction.toConst())
  const light = behind.mul(1 - even).toVar() as Vec3
  const inFront = measured.radianceAround(direction.negate().toConst())
  light.addAssign(behind.add(inFront).mul(even / 2))
  const view = place.normalize().toConst() as Vec3
  const phaseTo = (toLight: Vec3): Float => particlePhase(view.dot(toLight), concentration, even)
  for (const rays of measured.rays) {
    const direct = rays.illuminance(sizeClass)
    light.addAssign(direct.mul(phaseTo(rays.direction)))
  }
  for (const lamp of lamps) {
    const { illuminance, direction: toLamp } = lamp.at(place)
    light.addAssign(illuminance.mul(phaseTo(toLamp)))
  }
  return vec3(light)
}
