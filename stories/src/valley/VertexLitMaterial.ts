import { cloudShadow, CloudShadowNode } from '@welkin/clouds'
import type { Light } from 'three'
import {
  diffuseColor,
  Fn,
  If,
  mix,
  normalWorldGeometry,
  smoothstep,
  uniform,
  varying,
  vec3,
  vec4
} from 'three/tsl'
import { MeshLambertNodeMaterial, PhongLightingModel } from 'three/webgpu'
import type { LightingModelDirectInput, Node, NodeBuilder, UniformNode } from 'three/webgpu'

type Vec3 = Node<'vec3'>

/** Colour of snow, linear sRGB, and cosines of the slopes between which it comes to lie. */
const SNOW = [0.78, 0.8, 0.83] as const
const LYING = [0.12, 0.7] as const

/** Parts of three's light nodes and contexts of which its types have none. */
interface ShadowedLightNode {
  light: Light & { isDirectionalLight?: true }
  baseColorNode: Vec3 | null
  shadowNode: Node | null
}
interface LightsBuilder {
  context: {
    irradiance: { addAssign(node: Vec3): void }
    reflectedLight: { directDiffuse: { assign(node: Vec3): void } }
  }
  lightsNode: {
    getLightNodes(builder: unknown): ShadowedLightNode[]
    setupLights(builder: unknown, nodes: ShadowedLightNode[]): void
  }
}

/** 1 for lights that are computed. */
const _lit = new WeakMap<Light, UniformNode<'float', number>>()

function litOf(light: Light): UniformNode<'float', number> {
  let lit = _lit.get(light)
  if (lit === undefined) _lit.set(light, (lit = uniform(1)))
  return lit
}

/** Turns a light on or off for {@link VertexLitMaterial}, at no cost where it is off; nothing is compiled. */
export function setLit(light: Light, isLit: boolean): void {
  litOf(light).value = isLit ? 1 : 0
}

/** Shadows of clouds without those that they are multiplied with. */
const _ofCloudsAlone = new WeakMap<CloudShadowNode, CloudShadowNode>()

function ofCloudsAlone(shadow: CloudShadowNode): CloudShadowNode {
  let alone = _ofCloudsAlone.get(shadow)
  if (alone === undefined) {
    _ofCloudsAlone.set(shadow, (alone = cloudShadow(shadow.clouds, null, shadow.source)))
  }
  return alone
}

/** Sum of the colours of lights at the vertices; a light that is off is left out. */
const atVertices = (colors: readonly (readonly [light: Light, color: Vec3])[]): Vec3 =>
  varying(
    Fn(() => {
      const result = vec3(0).toVar()
      for (const [light, color] of colors) {
        If(litOf(light).greaterThan(0), () => {
          result.addAssign(color)
        })
      }
      return result
    })()
  )

/** Lambert's model whose light from all sides, and colours of directional lights, are of the vertices. */
class VertexLightingModel extends PhongLightingModel {
  constructor() {
    super(false)
  }

  override start(builder: NodeBuilder): void {
    const lit = builder as unknown as LightsBuilder
    const { context, lightsNode } = lit
    const { irradiance } = context
    // Before branches: three would begin the sum anew in each.
    context.reflectedLight.directDiffuse.assign(vec3(0))
    const received: [Light, Vec3][] = []
    for (const node of lightsNode.getLightNodes(lit)) {
      context.irradiance = { addAssign: color => received.push([node.light, color]) }
      lightsNode.setupLights(lit, [node])
    }
    context.irradiance = irradiance
    // One colour for all of them: what vertices hand on costs each pixel.
    if (received.length > 0) irradiance.addAssign(atVertices(received))
    this.indirect(builder)
  }

  override direct(input: LightingModelDirectInput, builder: NodeBuilder): void {
    const { light } = input.lightNode as unknown as ShadowedLightNode
    const lightColor = this.#colorOf(input)
    If(litOf(light).greaterThan(0), () => super.direct({ ...input, lightColor }, builder))
  }

  /** Colour of a light: of a directional one all but the shadows of things is of the vertices. */
  #colorOf({ lightColor, lightNode }: LightingModelDirectInput): Vec3 {
    const { light, baseColorNode, shadowNode } = lightNode as unknown as ShadowedLightNode
    if (light.isDirectionalLight !== true) return lightColor as Vec3
    const base = baseColorNode ?? (lightColor as Vec3)
    if (shadowNode instanceof CloudShadowNode && shadowNode.shadowNode !== null) {
      // Shadows of clouds are soft: they are found at the vertices, too.
      const color = atVertices([[light, base.mul(ofCloudsAlone(shadowNode))]])
      return color.mul(shadowNode.shadowNode as Vec3)
    }
    const color = atVertices([[light, base]])
    return baseColorNode === null ? color : color.mul(shadowNode as Vec3)
  }
}

/**
 * A matte material for dense meshes: light of sky and night, the colour that the air gives to sun and moon, and shadows of
 * clouds are found at the vertices, where they differ little from one to the next; what faces the sun and what lies in the
 * shadow of things, at each pixel.
 */
export class VertexLitMaterial extends MeshLambertNodeMaterial {
  static override get type(): string {
    return 'VertexLitMaterial'
  }

  /** Share of what faces the sky that snow covers, in [0, 1]; null for none. */
  snowNode: Node<'float'> | null = null

  override setupLightingModel(): PhongLightingModel {
    return new VertexLightingModel()
  }

  override setupDiffuseColor(builder: NodeBuilder): void {
    super.setupDiffuseColor(builder)
    if (this.snowNode === null) return
    const { rgb, a } = diffuseColor as unknown as Node<'vec4'>
    const lying = smoothstep(...LYING, normalWorldGeometry.y).mul(this.snowNode)
    diffuseColor.assign(vec4(mix(rgb, vec3(...SNOW), lying), a))
  }
}
