import type { Vector3 } from 'three'
import type { Triple } from '../air/cpu/color'
import type { Moon } from './Moon'

/**
 * Illuminance by the moon on a plane that faces it, reddened by the air and blocked by the planet.
 *
 * @param position - Position of the plane, world.
 * @returns Linear sRGB [lx].
 */
export function moonIlluminanceAt(moon: Moon, position: Vector3): Triple {
  return moon.atmosphere.query(position, moon.source).sunIlluminance(position)
}

/**
 * Illuminance by moonlit sky and ground on a plane.
 *
 * @param position - Position of the plane, world.
 * @param normal - Normal of the plane, world, unit length.
 * @returns Linear sRGB [lx].
 * @throws Before the tables were baked and read back: await `atmosphere.bake(renderer)` first.
 */
export function moonSkyIlluminanceAt(moon: Moon, position: Vector3, normal: Vector3): Triple {
  return moon.atmosphere.query(position, moon.source).skyIlluminance(position, normal)
}
