import type { Camera, OrthographicCamera } from 'three'
import { Fn, If, float, isBackgroundDepth, select, uv, vec3, vec4 } from 'three/tsl'
import type { Node, NodeBuilder, NodeFrame, PassNode } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import {
  checkAirOptions,
  shaftsIn,
  type AirOptions,
  type AirShadows,
  type ScreenShadows
} from '../view/AirShadows'
import type { SkyLayer } from '../view/SkyLayer'
import { DepthRays } from '../view/DepthRays'
import { PostEffectNode } from '../view/PostEffectNode'
import { Backdrop, passOf } from './Backdrop'
import { foregroundOf } from './tsl/foreground'
import { pixelAngle, skyColor } from './tsl/sky'
import { aerialPerspectiveTo } from './tsl/aerialPerspective'
import { seenIn } from './whereSeen'
import type { Bool, Float, Vec3, Vec4 } from '../tsl-types'

/**
 * Aerial perspective and sky as a post effect: dims what was drawn, adds the light scattered in front
 * of it, and draws the sky where nothing was.
 *
 * ```ts
 * const scenePass = pass(scene, camera, { samples: 0 })
 * pipeline.outputNode = aerialPerspective(
 *   scenePass.getTextureNode(), scenePass.getTextureNode('depth'), camera, atmosphere
 * )
 * ```
 *
 * The sky is where nothing wrote depth, whatever the colour's alpha or the scene's background there; what
 * is transparent is laid over it. Of an opaque backdrop (`scene.background`, `setClearColor`,
 * `WebGPURenderer({ alpha: false })`) the effect knows when colour or depth is the texture of a pass.
 * Without one, only alpha below 1 can tell what wrote no depth.
 *
 * Leave `scene.backgroundNode` and `scene.fogNode` empty, and draw without multisampling: a pixel has one
 * depth, which is wrong for most of its samples at silhouettes and, from space, everywhere (smooth
 * edges afterwards, or use the fog node). What is transparent and writes no depth gets the
 * air of what is behind it; the fog node has no such limit. Knows standard, reversed and logarithmic
 * depth, perspective and orthographic cameras. Its option `shafts` has shadows fall into air and sky.
 */
export class AerialPerspectiveNode extends PostEffectNode {
  static get type(): string {
    return 'AerialPerspectiveNode'
  }

  /** See {@link AirOptions}. */
  readonly showSky: boolean
  /** See {@link AirOptions}. */
  readonly showSun: boolean
  /** Shadows in the air, by lights; shared, not owned. */
  readonly shafts: readonly AirShadows[]
  readonly #screenShafts: readonly ScreenShadows[]
  readonly #rays: DepthRays
  readonly #backdrop = new Backdrop()

  /**
   * @throws If an argument is missing or of the wrong kind, an option is unknown or of the wrong kind, or shafts are of
   *   another camera or atmosphere.
   */
  constructor(
    colorNode: Node,
    depthNode: Node,
    camera: Camera,
    atmosphere: Atmosphere,
    options: AirOptions = {}
  ) {
    super(colorNode, depthNode, camera, atmosphere)
    checkAirOptions('AerialPerspectiveNode', options)
    const { shafts, showSky = true, showSun = true } = options
    this.shafts = shaftsIn(shafts)
    this.showSky = showSky
    this.showSun = showSun
    this.#rays = new DepthRays(depthNode, camera)
    this.#screenShafts = this.shafts.map(each => each.upTo(depthNode, undefined, this))
  }

  /** Layers of the sky, and shafts for all pixels at once in place of those that materials have. */
  protected override get layers(): readonly SkyLayer[] {
    const inMaterials = this.shafts as readonly SkyLayer[]
    const layers = this.atmosphere.layers.filter(layer => !inMaterials.includes(layer))
    return [...layers, ...this.#screenShafts]
  }

  override customCacheKey(): number {
    return 4 * super.customCacheKey() + (this.showSky ? 1 : 0) + (this.showSun ? 2 : 0)
  }

  override update(frame: NodeFrame): undefined {
    super.update(frame)
    if (frame.renderer !== null) this.#backdrop.update(frame.renderer, this.#pass)
  }

  get #pass(): PassNode | null {
    return passOf(this.colorNode) ?? passOf(this.depthNode)
  }

  /** Colour that was drawn, with the alpha that the pass left where effects in between have made it 1. */
  #color(): Vec4 {
    const color = vec4(this.colorNode as Vec4).toConst() as Vec4
    const pass = this.#pass
    if (!this.showSky || pass === null || passOf(this.colorNode) === pass) return color
    const { a } = (pass.getTextureNode() as unknown as Vec4).toConst() as Vec4
    return vec4(color.rgb, select(color.a.lessThan(1), color.a, a)).toConst()
  }

  override dispose(): void {
    for (const each of this.#screenShafts) each.dispose?.()
    super.dispose()
  }

  override setup(builder: NodeBuilder): Node {
    const isOrthographic = (this.camera as OrthographicCamera).isOrthographicCamera
    const position = (depth: Float): Vec3 => this.#rays.position(builder.renderer, uv(), depth)
    const seen = seenIn(builder)
    const ifSeen = (condition: Bool): Bool => (seen === null ? condition : seen.and(condition))

    return Fn(() => {
      const drawn = this.#color()
      const depth = float((this.depthNode as Vec4).r).toConst() as Float
      // Any depth that is neither near nor far gives the direction.
      const middle = position(float(0.5)).toConst() as Vec3
      const isSky = isBackgroundDepth(depth).toConst() as Bool
      const { light, coverage } = this.showSky
        ? foregroundOf(drawn, isSky, this.#backdrop)
        : { light: drawn.rgb, coverage: float(1) }
      const result = light.toVar()
      const ray = isOrthographic ? (vec3(0, 0, -1) as unknown as Vec3) : middle
      // Derivatives belong outside of branches; GLSL does not take that of a constant.
      const pixel = isOrthographic ? (float(0) as Float) : pixelAngle(ray.normalize())
      const shafts = this.#screenShafts
      const drawnAt = shafts.length > 0 ? position(depth).toConst() : null
      const lost = shafts
        .flatMap(each => each.lostAt(isSky.select(ray, drawnAt).toConst(), isSky) ?? [])
        .reduce<Vec3 | undefined>((sum, more) => sum?.add(more) ?? more, undefined)
      If(ifSeen(isSky.not()), () => {
        const air = aerialPerspectiveTo(this.view, drawnAt ?? position(depth), this.layers, lost)
        result.assign(light.mul(air.transmittance).add(air.inScatter.mul(coverage)))
      })
      if (this.showSky) {
        // Silhouettes (with multisampling) and transparent things cover a part of the pixel.
        If(ifSeen(coverage.lessThan(1)), () => {
          const direction = this.view.toMapped(ray).normalize().toConst() as Vec3
          const sky = skyColor(this.view, direction, this.showSun ? pixel : null, this.layers, lost)
          result.addAssign(sky.mul(coverage.oneMinus()))
        })
      }
      return vec4(result, this.showSky ? float(1) : drawn.a)
    })()
  }
}

/** Aerial perspective and sky as a post effect: see {@link AerialPerspectiveNode}. */
export const aerialPerspective = (
  color: Node,
  depth: Node,
  camera: Camera,
  atmosphere: Atmosphere,
  options?: AirOptions
): AerialPerspectiveNode => new AerialPerspectiveNode(color, depth, camera, atmosphere, options)
