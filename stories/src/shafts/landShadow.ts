import type { MoonDirectionalLight, SunDirectionalLight } from '@welkin/atmosphere'

/** Distance of a light from its target: its shadows begin there [m]. */
export const LIGHT_DISTANCE = 20_000

/** Half widths of the shadow maps of hills, and of a city [m]. */
const SHADOW_EXTENT = 6000
const CITY_SHADOW_EXTENT = 1500

/** Gives a light shadows of the land. @returns The light. */
export function castLandShadow<L extends SunDirectionalLight | MoonDirectionalLight>(
  light: L,
  land: string | undefined
): L {
  const extent = land === 'city' ? CITY_SHADOW_EXTENT : SHADOW_EXTENT
  light.castShadow = true
  light.distance = LIGHT_DISTANCE
  light.shadow.mapSize.setScalar(4096)
  light.shadow.normalBias = extent / 300
  const { camera } = light.shadow
  camera.left = camera.bottom = -extent
  camera.right = camera.top = extent
  camera.far = 3 * LIGHT_DISTANCE
  return light
}
