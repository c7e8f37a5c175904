import type { Light } from 'three'
import { If, uniform, vec3 } from 'three/tsl'
import type { Node, UniformNode } from 'three/webgpu'

type Vec3 = Node<'vec3'>

/** Parts of three's light nodes and contexts of which its types have none. */
export interface ShadowedLightNode {
  light: Light & { isDirectionalLight?: true }
  baseColorNode: Vec3 | null
  shadowNode: Node | null
}
export interface LightsBuilder {
  material: object
  context: {
    irradiance: { addAssign(node: Vec3): void }
    reflectedLight: { directDiffuse: { assign(node: Vec3): void } }
  }
  lightsNode: {
    getLightNodes(builder: unknown): ShadowedLightNode[]
    setupLights(builder: unknown, nodes: ShadowedLightNode[]): void
  }
}

/** A light, and its colour where it is received. */
export type ReceivedLight = readonly [light: Light, color: Vec3]

/** 1 for lights that are computed. */
const _lit = new WeakMap<Light, UniformNode<'float', number>>()

export function litOf(light: Light): UniformNode<'float', number> {
  let lit = _lit.get(light)
  if (lit === undefined) _lit.set(light, (lit = uniform(1)))
  return lit
}

/** Turns a light on or off for materials that ask, at no cost where it is off; nothing is compiled. */
export function setLit(light: Light, isLit: boolean): void {
  litOf(light).value = isLit ? 1 : 0
}

/**
 * Has three set lights up one by one, direct ones by the lighting model.
 *
 * @param isTaken - False for lights that are left out.
 * @returns Light that comes from all sides.
 */
export function received(
  lit: LightsBuilder,
  isTaken: (light: Light) => boolean = () => true
): ReceivedLight[] {
  const { context, lightsNode } = lit
  const { irradiance } = context
  const result: ReceivedLight[] = []
  for (const node of lightsNode.getLightNodes(lit)) {
    if (!isTaken(node.light)) continue
    context.irradiance = { addAssign: color => result.push([node.light, color]) }
    lightsNode.setupLights(lit, [node])
  }
  context.irradiance = irradiance
  return result
}

/** Sum of the colours of lights; one that is off is left out. To be called inside of a shader function. */
export function sumOfLit(colors: readonly ReceivedLight[]): Vec3 {
  const result = vec3(0).toVar()
  for (const [light, color] of colors) {
    If(litOf(light).greaterThan(0), () => {
      result.addAssign(color)
    })
  }
  return result
}
