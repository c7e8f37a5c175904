import type { Camera, Light } from 'three'
import { Fn, If, float, isBackgroundDepth, mix, texture, uniform, uv, vec4 } from 'three/tsl'
import { Node, NodeUpdateType } from 'three/webgpu'
import type { NodeFrame, TextureNode } from 'three/webgpu'
import { checkNonNegative, checkOptions, fail, setOptions } from '@welkin/geo'
import { checkCamera, checkRange } from '../check'
import { tableTarget } from '../tables/FragmentPass'
import { sampleLevel0, type Bool, type Float, type Vec3, type Vec4 } from '../tsl-types'
import { DepthRays } from '../view/DepthRays'
import { drawnSize } from '../view/renderers'
import { depthNormalHere, depthPositionHere } from './tsl/depthSurface'
import { WhiteSurfaces } from './WhiteSurfaces'

/** Options of {@link SurfaceLightingNode}. */
export interface SurfaceLightingOptions {
  /** See {@link SurfaceLightingNode.strength}; by default 1. */
  strength?: number
  /** See {@link SurfaceLightingNode.albedo}; by default 1. */
  albedo?: number
  /** Normals in view space, unit length; by default they are found from depth. */
  normal?: Node
  /** Part of each pixel that is lit, in [0, 1]: 0 for what materials have lit already; by default 1. */
  mask?: Node
}

const WHERE = 'SurfaceLightingNode'
const SETTINGS = ['strength', 'albedo'] as const

function checkNode(name: string, value: Node | undefined): void {
  if (!value?.isNode) fail(WHERE, `${name} must be a node`, value)
}

/**
 * Lights a picture of surfaces that are not lit, such as photogrammetry tiles, whose photographs have light of their own.
 * The picture is taken for their albedo.
 *
 * ```ts
 * const scenePass = pass(scene, camera, { samples: 0 })
 * const depth = scenePass.getTextureNode('depth')
 * const lit = surfaceLighting(scenePass.getTextureNode(), depth, camera, [sun, sky])
 * pipeline.outputNode = aerialPerspective(lit, depth, camera, atmosphere)
 * ```
 *
 * The lights are any of three's and Welkin's that stand in the scene of the pass: sun, sky and night probes, moonlight,
 * lamps. They give what a Lambert material would have of them, with their shadow maps and whatever is their
 * `shadow.shadowNode`, such as a `cloudShadow`. Meshes with `castShadow` cast shadows as ever, unlit ones too.
 *
 * Light is drawn at half-float precision into a texture of the picture's size, by a pass of its own. Put the node before
 * air and clouds. Knows standard, reversed and logarithmic depth, perspective and orthographic cameras; normals of what
 * is far away need reversed or logarithmic depth. Draw without multisampling.
 */
export class SurfaceLightingNode extends Node<'vec4'> {
  static get type(): string {
    return 'SurfaceLightingNode'
  }

  /** Picture of unlit surfaces, linear. */
  readonly colorNode: Node
  /** Its depth, as the renderer writes it: a texture's node. */
  readonly depthNode: Node
  /** The camera that drew it. */
  readonly camera: Camera
  /** Lights; shared, not owned. Those that are not `visible` give none. */
  readonly lights: readonly Light[]
  readonly #mask: Node | undefined
  readonly #strength = uniform(1)
  readonly #albedo = uniform(1)
  readonly #surfaces: WhiteSurfaces
  readonly #target = tableTarget('Welkin.SurfaceLighting', 1, 1)
  readonly #light: TextureNode

  /** @throws If an argument is missing or of the wrong kind, or an option is unknown or out of range. */
  constructor(
    colorNode: Node,
    depthNode: Node,
    camera: Camera,
    lights: readonly Light[],
    options: SurfaceLightingOptions = {}
  ) {
    super('vec4')
    checkNode('colorNode', colorNode)
    if ((depthNode as Partial<TextureNode>)?.isTextureNode !== true)
      fail(WHERE, "depthNode must be a texture's node", depthNode)
    checkCamera(WHERE, camera)
    if (!Array.isArray(lights)) fail(WHERE, 'lights must be an array of Lights', lights)
    lights.forEach((light: Light, i) => {
      if (!light?.isLight) fail(WHERE, `lights[${i}] must be a Light`, light)
    })
    const { normal, mask, ...settings } = checkOptions(
      WHERE,
      options,
      ...SETTINGS,
      'normal',
      'mask'
    )
    if (normal !== undefined) checkNode('normal', normal)
    if (mask !== undefined) checkNode('mask', mask)
    this.colorNode = colorNode
    this.depthNode = depthNode
    this.camera = camera
    this.lights = [...lights]
    this.#mask = mask
    const rays = new DepthRays(depthNode, camera)
    const position = depthPositionHere(rays)
    this.#surfaces = new WhiteSurfaces(
      'Welkin.SurfaceLighting',
      position,
      normal ?? depthNormalHere(rays)
    )
    this.#light = texture(this.#target.texture)
    this.updateBeforeType = NodeUpdateType.RENDER
    this.set(settings)
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or refused; then nothing has changed.
   */
  set(settings: Pick<SurfaceLightingOptions, (typeof SETTINGS)[number]>): this {
    return setOptions(WHERE, this, settings, ...SETTINGS)
  }

  /** Share of the light in the picture, in [0, 1]: 0 leaves the picture as it is, bit for bit, at no cost [–]. */
  get strength(): number {
    return this.#strength.value
  }

  set strength(value: number) {
    checkRange(WHERE, 'strength', value, 0, 1)
    this.#strength.value = value
  }

  /** Albedo of white in the picture, finite, ≥ 0: photographs are mostly brighter than what they show [–]. */
  get albedo(): number {
    return this.#albedo.value
  }

  set albedo(value: number) {
    checkNonNegative(WHERE, 'albedo', value)
    this.#albedo.value = value
  }

  override updateBefore({ renderer }: NodeFrame): undefined {
    if (renderer === null || this.strength === 0) return
    const { width, height } = drawnSize(renderer)
    this.#target.setSize(width, height)
    this.#surfaces.render(renderer, this.camera, this.lights, this.#target)
  }

  override setup(): Node {
    return Fn(() => {
      const color = vec4(this.colorNode as Vec4).toConst()
      const depth = float((this.depthNode as Vec4).r).toConst()
      const mask = this.#mask === undefined ? 1 : float(this.#mask as Float).clamp()
      const amount = this.#strength.mul(mask).toConst() as Float
      const result = color.rgb.toVar() as Vec3
      const isSurface = (isBackgroundDepth(depth) as unknown as Bool).not()
      If(amount.greaterThan(0).and(isSurface), () => {
        const light = sampleLevel0(this.#light, uv())
        result.assign(mix(color.rgb, color.rgb.mul(light.rgb).mul(this.#albedo), amount))
      })
      return vec4(result, color.a)
    })()
  }

  /** Frees its texture and pipeline. It can be used again. */
  override dispose(): void {
    this.#target.dispose()
    this.#surfaces.dispose()
    super.dispose()
  }
}

/** Lights a picture of unlit surfaces: see {@link SurfaceLightingNode}. */
export const surfaceLighting = (
  color: Node,
  depth: Node,
  camera: Camera,
  lights: readonly Light[],
  options?: SurfaceLightingOptions
): SurfaceLightingNode => new SurfaceLightingNode(color, depth, camera, lights, options)
