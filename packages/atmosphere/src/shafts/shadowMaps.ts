import type { DepthTexture, DirectionalLight, LightShadow, Matrix4, Vector4 } from 'three'
import { Vector4 as Box } from 'three'

/** A shadow map as a light has drawn it. */
export interface ShadowMap {
  readonly depth: DepthTexture
  /** World space to the map's coordinates: a point of the texture, and depth. */
  readonly matrix: Matrix4
  /** Part of the texture that is its own: first and last coordinates. */
  readonly bounds: Vector4
}

/** A light's shadow of one map, or of several that share a texture, such as three's `SunLight` has. */
type Shadow = LightShadow & { getMatrix?(index: number): Matrix4 }

/** A node in a shadow's slot: `CSMShadowNode`, which has a light for each cascade, or one around another. */
interface ShadowSlot {
  readonly lights?: readonly { shadow: Shadow }[]
  readonly shadowNode?: ShadowSlot | null
}

function mapsOf(shadow: Shadow): ShadowMap[] {
  const depth = shadow.map?.depthTexture
  if (!depth) return []
  const { x: width, y: height } = shadow.getFrameExtents()
  return Array.from({ length: shadow.getViewportCount() }, (_, i) => {
    const { x, y, z, w } = shadow.getViewport(i)
    const bounds = new Box(x / width, y / height, (x + z) / width, (y + w) / height)
    return { depth, matrix: shadow.getMatrix?.(i) ?? shadow.matrix, bounds }
  })
}

/** All shadow maps that a light has drawn so far: its own, `CSMShadowNode`'s cascades, or `SunLight`'s. */
export function shadowMapsOf({ castShadow, shadow }: DirectionalLight): ShadowMap[] {
  if (!castShadow) return []
  let slot: ShadowSlot | null | undefined = (shadow as unknown as ShadowSlot).shadowNode
  while (slot) {
    if (slot.lights) return slot.lights.flatMap(light => mapsOf(light.shadow))
    slot = slot.shadowNode
  }
  return mapsOf(shadow)
}
