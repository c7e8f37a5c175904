import { Vector4 } from 'three'
import type { Camera, DepthTexture, Light, LightShadow, Matrix4, Scene } from 'three'
import { shadow as shadowNodeOf } from 'three/tsl'
import { ShadowNode } from 'three/webgpu'
import type { NodeFrame } from 'three/webgpu'
import type { LightSource } from '../view/LightSource'

/** Light of parallel rays: three's `DirectionalLight` or `SunLight`, or one of the atmosphere's, which has a source. */
export type ParallelLight = Light & { shadow?: LightShadow; readonly source?: LightSource }

/** A shadow map as a light has drawn it. */
export interface ShadowMap {
  readonly depth: DepthTexture
  /** World space to the map's coordinates: a point of the texture, and depth. */
  readonly matrix: Matrix4
  /** Part of the texture that is its own: first and last coordinates. */
  readonly bounds: Vector4
  /** Part of the light that its shadows take, in [0, 1]: `LightShadow.intensity` [–]. */
  readonly intensity: number
}

/** A light's shadow of one map, or of several that share a texture, such as three's `SunLight` has. */
type Shadow = LightShadow & {
  getMatrix?(index: number): Matrix4
  readonly isDirectionalLightShadow?: boolean
}

type PlainShadowNode = ReturnType<typeof shadowNodeOf> & Pick<ShadowSlot, 'shadowMap'>

/** A node in a shadow's slot: `CSMShadowNode`, which has a light for each cascade, or one around another. */
interface ShadowSlot {
  readonly lights?: readonly { shadow: Shadow }[]
  /** Nodes of those lights. */
  readonly _shadowNodes?: readonly ShadowSlot[]
  readonly shadowNode?: ShadowSlot | null
  /** Map that it draws. */
  readonly shadowMap?: object | null
  updateBefore(frame: NodeFrame): unknown
}

/** The shadow's own nodes, from the outermost to the innermost. */
function slotsOf(shadow: LightShadow): ShadowSlot[] {
  const slots: ShadowSlot[] = []
  let slot = (shadow as unknown as ShadowSlot).shadowNode
  while (slot) {
    slots.push(slot)
    slot = slot.shadowNode
  }
  return slots
}

/** Nodes that were put into the empty slots of shadows, and those who have use for them. */
const claims = new WeakMap<LightShadow, { node: PlainShadowNode; users: Set<object> }>()

/** Has a node that {@link drawShadow} finds draw a plain shadow, until it is released; not once three has made one. */
export function claimShadow(light: ParallelLight, user: object): void {
  const shadow = light.shadow as Shadow
  let claim = claims.get(shadow)
  if (shadow.map && shadow.map !== claim?.node.shadowMap) return
  if (claim === undefined) {
    if (!shadow.isDirectionalLightShadow || shadow.shadowNode) return
    claim = { node: shadowNodeOf(light), users: new Set() }
    claims.set(shadow, claim)
  }
  claim.users.add(user)
  shadow.shadowNode ??= claim.node
}

/** Empties the slot of a shadow again, once nobody has use for the node in it. */
export function releaseShadow(light: ParallelLight, user: object): void {
  const shadow = light.shadow as Shadow
  const claim = claims.get(shadow)
  if (!claim?.users.delete(user) || claim.users.size > 0) return
  if (shadow.shadowNode === claim.node) delete shadow.shadowNode
}

/**
 * Draws the shadow maps now, if three would draw them later in the frame, or not at all since nothing in
 * view takes shadows. Those of `SunLight` are drawn by three alone.
 *
 * @returns True if the maps are those of the frame.
 */
export function drawShadow(light: ParallelLight, frame: NodeFrame, camera: Camera): boolean {
  let root: ParallelLight['parent'] = light
  while (root.parent) root = root.parent
  const slots = slotsOf(light.shadow!)
  const cascades = slots.find(slot => slot._shadowNodes)
  const nodes: readonly ShadowSlot[] =
    cascades?._shadowNodes ?? slots.filter(slot => (slot as unknown) instanceof ShadowNode)
  const isReady = nodes.length > 0 && nodes.every(({ shadowMap }) => shadowMap)
  if (!light.castShadow || !isReady || !(root as Partial<Scene>).isScene) return false
  const { renderer, frameId } = frame
  const seen = { renderer, frameId, camera, scene: root } as unknown as NodeFrame
  cascades?.updateBefore(seen)
  for (const node of nodes) node.updateBefore(seen)
  return true
}

function mapsOf(shadow: Shadow): ShadowMap[] {
  const depth = shadow.map?.depthTexture
  if (!depth) return []
  const { x: width, y: height } = shadow.getFrameExtents()
  return Array.from({ length: shadow.getViewportCount() }, (_, i) => {
    const { x, y, z, w } = shadow.getViewport(i)
    const bounds = new Vector4(x / width, y / height, (x + z) / width, (y + w) / height)
    const { intensity } = shadow
    return { depth, matrix: shadow.getMatrix?.(i) ?? shadow.matrix, bounds, intensity }
  })
}

/** All shadow maps that a light has drawn so far: its own, `CSMShadowNode`'s cascades, or `SunLight`'s. */
export function shadowMapsOf({ castShadow, shadow }: ParallelLight): ShadowMap[] {
  if (!castShadow || !shadow) return []
  const cascades = slotsOf(shadow).find(slot => slot.lights)?.lights
  return cascades?.flatMap(light => mapsOf(light.shadow)) ?? mapsOf(shadow)
}
