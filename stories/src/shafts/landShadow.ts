import type { MoonDirectionalLight, SunDirectionalLight } from '@welkin/atmosphere'
import { DirectionalLight } from 'three'
import { shadow } from 'three/tsl'
import type { Node } from 'three/webgpu'

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

/** Layer of what casts shadows in the map of the ground near by too: trees and hedges, and not the land itself. */
export const NEAR_LAYER = 1

/** Half width of that map, and distance within which trees are in it [m]. */
const NEAR_EXTENT = 300
export const NEAR_REACH = 260

/** Texels along an edge of it, and its bias along normals [m]. */
const NEAR_TEXELS = 2048
const NEAR_BIAS = 0.35

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

/**
 * Shadows of a light that has a map by {@link castLandShadow}: of all the land, and finer ones of plants near by.
 *
 * @param hasPlants - True where such plants are.
 */
export function landShadow(
  light: SunDirectionalLight | MoonDirectionalLight,
  hasPlants: boolean
): Node<'float'> {
  const far = shadow(light) as unknown as Node<'float'>
  if (!hasPlants) return far
  const { shadow: near } = new DirectionalLight()
  near.mapSize.setScalar(NEAR_TEXELS)
  near.normalBias = NEAR_BIAS
  const { camera } = near
  camera.left = camera.bottom = -NEAR_EXTENT
  camera.right = camera.top = NEAR_EXTENT
  camera.far = 3 * LIGHT_DISTANCE
  camera.layers.set(NEAR_LAYER)
  light.addEventListener('dispose', () => near.dispose())
  return far.mul(shadow(light, near) as unknown as Node<'float'>)
}
