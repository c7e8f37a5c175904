import type { MoonDirectionalLight, SunDirectionalLight } from '@welkin/atmosphere'

/** Distance of a light from its target: its shadows begin there [m]. */
export const LIGHT_DISTANCE = 20_000

/** Half width of the shadow map of lands that are not in `EXTENTS` [m]. */
const SHADOW_EXTENT = 6000

/** Half widths of the shadow maps of lands by their names [m]. */
const EXTENTS: Readonly<Record<string, number>> = { city: 1500, ridge: 1200 }

/** Bias along normals over the half width of the shadow map [–]. */
const BIAS = 1 / 300

/** Bias of a ridge's shadow map, over its half width: less, since trees are thin [–]. */
const RIDGE_BIAS = 1 / 2400

/**
 * Gives a light a shadow map about its target that is as wide as the land in view.
 *
 * @param land - Name of the land, as of the story's arguments.
 * @returns The light.
 */
export function castLandShadow<L extends SunDirectionalLight | MoonDirectionalLight>(
  light: L,
  land: string | undefined
): L {
  const extent = EXTENTS[land ?? ''] ?? SHADOW_EXTENT
  light.castShadow = true
  light.distance = LIGHT_DISTANCE
  light.shadow.mapSize.setScalar(4096)
  light.shadow.normalBias = extent * (land === 'ridge' ? RIDGE_BIAS : BIAS)
  const { camera } = light.shadow
  camera.left = camera.bottom = -extent
  camera.right = camera.top = extent
  camera.far = 3 * LIGHT_DISTANCE
  return light
}
