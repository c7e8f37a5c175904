import { cloudShadow, CloudShadowNode } from '@welkin/clouds'
import type { Light } from 'three'
import {
  diffuseColor,
  Fn,
  If,
  mix,
  normalView,
  normalViewGeometry,
  normalWorldGeometry,
  smoothstep,
  varying,
  vec3,
  vec4
} from 'three/tsl'
import { MeshLambertNodeMaterial, PhongLightingModel } from 'three/webgpu'
import type { LightingModelDirectInput, Node, NodeBuilder } from 'three/webgpu'
import {
  type LightsBuilder,
  litOf,
  received,
  type ReceivedLight,
  type ShadowedLightNode,
  sumOfLit
} from './litLights'
import type { SkyLightMap } from './SkyLightMap'

type Vec3 = Node<'vec3'>

/** Colour of snow, linear sRGB, and cosines of the slopes between which it comes to lie. */
const SNOW = [0.78, 0.8, 0.83] as const
const LYING = [0.12, 0.7] as const

/** Part of its brightness that a wet surface keeps: of what it scatters, its film mirrors half back (Lekner & Dorf 1988). */
const WET = 0.6

/** Sum of a light's primaries below which it is not seen: a thousandth of middle grey. */
const UNSEEN = 2e-4

/** Maps that have the light of a light. */
const _mapped = new WeakMap<Light, SkyLightMap>()

/** Has the light of some lights read from a map, of which there is one for all of them. Before the first frame. */
export function setMapped(lights: readonly Light[], map: SkyLightMap): void {
  for (const light of lights) _mapped.set(light, map)
}

/** Lights that are found at the vertices whole, with how surfaces face them. */
const _distant = new WeakSet<Light>()

/** Has the light of a distant lamp found at the vertices: it costs pixels nothing. Before the first frame. */
export function setDistant(light: Light): void {
  _distant.add(light)
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

/** Sum of the colours of lights, and of a map of others, at the vertices; a light that is off is left out. */
const atVertices = (colors: readonly ReceivedLight[], map?: SkyLightMap): Vec3 =>
  varying(Fn(() => (map === undefined ? sumOfLit(colors) : sumOfLit(colors).add(map.sample())))())

/** Lambert's model whose light from all sides, and colours of directional lights, are of the vertices. */
class VertexLightingModel extends PhongLightingModel {
  /** Distant lights that `direct` was given. */
  readonly #distant: ReceivedLight[] = []

  constructor() {
    super(false)
  }

  override start(builder: NodeBuilder): void {
    const lit = builder as unknown as LightsBuilder
    const { context, lightsNode } = lit
    // Before branches: three would begin the sum anew in each.
    context.reflectedLight.directDiffuse.assign(vec3(0))
    const [map] = lightsNode.getLightNodes(lit).flatMap(({ light }) => _mapped.get(light) ?? [])
    const others = received(lit, light => !_mapped.has(light))
    others.push(...this.#distant.splice(0))
    // One colour for all of them: what vertices hand on costs each pixel.
    if (others.length > 0 || map !== undefined) {
      const light = atVertices(others, map)
      const { openNode } = lit.material as VertexLitMaterial
      context.irradiance.addAssign(openNode ? light.mul(openNode) : light)
    }
    this.indirect(builder)
  }

  override direct(input: LightingModelDirectInput, builder: NodeBuilder): void {
    const { light } = input.lightNode as unknown as ShadowedLightNode
    if (_distant.has(light)) {
      const facing = normalViewGeometry.dot(input.lightDirection as Vec3).max(0)
      this.#distant.push([light, (input.lightColor as Vec3).mul(facing)])
      return
    }
    const { color, shadow } = this.#colorOf(input)
    const add = (lightColor: Vec3): void => super.direct({ ...input, lightColor }, builder)
    If(litOf(light).greaterThan(0), () => {
      if (shadow === null) return add(color)
      // Shadows are looked up only where there is light to lose.
      const facing = normalView.dot(input.lightDirection as Vec3).greaterThan(0)
      const bright = color.r.add(color.g).add(color.b).greaterThan(UNSEEN)
      If(facing.and(bright), () => add(color.mul(shadow)))
    })
  }

  /** Colour of a light, and shadows of things in it: of a directional light all but these is of the vertices. */
  #colorOf({ lightColor, lightNode }: LightingModelDirectInput): {
    color: Vec3
    shadow: Vec3 | null
  } {
    const { light, baseColorNode, shadowNode } = lightNode as unknown as ShadowedLightNode
    if (light.isDirectionalLight !== true) return { color: lightColor as Vec3, shadow: null }
    const base = baseColorNode ?? (lightColor as Vec3)
    if (shadowNode instanceof CloudShadowNode && shadowNode.shadowNode !== null) {
      // Shadows of clouds are soft: they are found at the vertices, too.
      const color = atVertices([[light, base.mul(ofCloudsAlone(shadowNode))]])
      return { color, shadow: shadowNode.shadowNode as Vec3 }
    }
    const color = atVertices([[light, base]])
    return { color, shadow: baseColorNode === null ? null : (shadowNode as Vec3) }
  }
}

/**
 * A matte material for dense meshes: light of sky, night and {@link setDistant distant lamps}, the colour that the air gives to sun and moon, and shadows of
 * clouds are found at the vertices, where they differ little from one to the next; what faces the sun and what lies in the
 * shadow of things, at each pixel.
 */
export class VertexLitMaterial extends MeshLambertNodeMaterial {
  static override get type(): string {
    return 'VertexLitMaterial'
  }

  /** Share of what faces the sky that snow covers, in [0, 1]; null for none. */
  snowNode: Node<'float'> | null = null

  /** Share of the surface that is wet, in [0, 1]; null for none. */
  wetNode: Node<'float'> | null = null

  /** Share of the sky that is seen from a place, in [0, 1]; null for all of it. */
  openNode: Node<'float'> | null = null

  /** Cosines of the slopes between which snow comes to lie; branches hold it on steep crowns. */
  lying: readonly [number, number] = LYING

  override setupLightingModel(): PhongLightingModel {
    return new VertexLightingModel()
  }

  override setupDiffuseColor(builder: NodeBuilder): void {
    super.setupDiffuseColor(builder)
    if (this.wetNode !== null) {
      const { rgb, a } = diffuseColor as unknown as Node<'vec4'>
      diffuseColor.assign(vec4(rgb.mul(this.wetNode.mul(WET - 1).add(1)), a))
    }
    if (this.snowNode === null) return
    const { rgb, a } = diffuseColor as unknown as Node<'vec4'>
    const lying = smoothstep(...this.lying, normalWorldGeometry.y).mul(this.snowNode)
    diffuseColor.assign(vec4(mix(rgb, vec3(...SNOW), lying), a))
  }
}
