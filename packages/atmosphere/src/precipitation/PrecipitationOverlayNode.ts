import { Scene, type Camera } from 'three'
import { Fn, If, texture, uv, vec4 } from 'three/tsl'
import { Node, NodeUpdateType, RendererUtils } from 'three/webgpu'
import type { NodeFrame, TextureNode } from 'three/webgpu'
import { fail } from '@welkin/geo'
import { checkCamera } from '../check'
import { tableTarget } from '../tables/FragmentPass'
import { sampleLevel0, type Vec3, type Vec4 } from '../tsl-types'
import { number } from '../uniforms'
import { drawnSize } from '../view/renderers'
import type { Precipitation } from './Precipitation'

/**
 * Least share of the hidden background that shines through particles, as by the forward lobe of flakes: light measured at the camera has no
 * part of walls and ground that lamps light. 0: near flakes are black before lit snow (*Rain and snow in a street*).
 */
const FORWARD = 0.65

/**
 * Lays rain and snow over a picture that has its air and clouds already.
 *
 * ```ts
 * const rain = rainfall(atmosphere, { lights: [sun, sky], depth, depthCamera: camera })
 * pipeline.outputNode = precipitationOverlay(air, camera, [rain])
 * ```
 *
 * It is drawn in a pass of its own, of half floats and the picture's size, while anything falls; the depth that it was given hides it. It is taken into a
 * scene of the node's own.
 */
export class PrecipitationOverlayNode extends Node<'vec4'> {
  static get type(): string {
    return 'PrecipitationOverlayNode'
  }

  /** Picture, linear. */
  readonly colorNode: Node
  /** The camera that drew it. */
  readonly camera: Camera
  readonly #scene = new Scene()
  readonly #falling: readonly Precipitation[]
  /** 1 while anything falls. */
  readonly #isFalling = number()
  readonly #target = tableTarget('Welkin.Precipitation', 1, 1)
  readonly #texture: TextureNode = texture(this.#target.texture)

  /** @throws If an argument is missing or of the wrong kind. */
  constructor(colorNode: Node, camera: Camera, falling: readonly Precipitation[]) {
    super('vec4')
    const where = 'PrecipitationOverlayNode'
    if (!colorNode?.isNode) fail(where, 'colorNode must be a node', colorNode)
    checkCamera(where, camera)
    if (!Array.isArray(falling)) fail(where, 'falling must be an array', falling)
    falling.forEach((one: Precipitation, i) => {
      if (!one?.isPrecipitation) fail(where, `falling[${i}] must be rainfall or snowfall`, one)
    })
    this.colorNode = colorNode
    this.camera = camera
    this.#falling = falling
    this.#scene.add(...falling)
    this.updateBeforeType = NodeUpdateType.FRAME
  }

  override updateBefore({ renderer }: NodeFrame): undefined {
    const isFalling = this.#falling.some(({ rate, visible }) => visible && rate > 0)
    this.#isFalling.value = isFalling ? 1 : 0
    if (renderer === null || !isFalling) return
    const { width, height } = drawnSize(renderer)
    this.#target.setSize(width, height)
    const state = RendererUtils.resetRendererState(renderer, {} as never)
    renderer.setRenderTarget(this.#target)
    renderer.setClearColor(0x000000, 0)
    renderer.autoClear = true
    renderer.render(this.#scene, this.camera)
    RendererUtils.restoreRendererState(renderer, state)
  }

  override setup(): Node {
    return Fn((): Vec4 => {
      const color = vec4(this.colorNode as Vec4).toConst() as Vec4
      const result = color.rgb.toVar() as Vec3
      If(this.#isFalling.greaterThan(0), () => {
        const { rgb, a } = sampleLevel0(this.#texture, uv()).toConst() as Vec4
        const light = rgb.max(color.rgb.mul(a).mul(FORWARD))
        result.assign(color.rgb.mul(a.oneMinus()).add(light))
      })
      return vec4(result, color.a)
    })()
  }

  /** Frees its texture, not what falls. It can be used again. */
  override dispose(): void {
    this.#target.dispose()
    super.dispose()
  }
}

/** Lays rain and snow over a picture: see {@link PrecipitationOverlayNode}. */
export const precipitationOverlay = (
  color: Node,
  camera: Camera,
  falling: readonly Precipitation[]
): PrecipitationOverlayNode => new PrecipitationOverlayNode(color, camera, falling)
