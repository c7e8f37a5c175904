import { NearestFilter, Vector2 } from 'three'
import type { Camera, RenderTarget } from 'three'
import { Fn, float, log2, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Node, NodeFrame, Renderer, TextureNode } from 'three/webgpu'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { RADIANCE_SCALE } from '../tables/tableSizes'
import { sampleLevel0, type Float, type Vec2, type Vec4 } from '../tsl-types'
import { vector2 } from '../uniforms'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { PointRay, SkyLayer, SkyRay } from '../view/SkyLayer'
import type { ViewNodes } from '../view/ViewNodes'
import { lostLight, staggered, type ShadowedAir, type ShaftSteps } from './tsl/lostLight'
import { DepthRays } from '../view/DepthRays'

/** Octaves of depth by which pixels may differ and still share light, and by which they share none. */
const SAME_DEPTH = 0.2
const OTHER_DEPTH = 0.6

/** Weight of pixels of another depth, where there are no others. */
const STRANGER = 1e-3

const _size = new Vector2()

/** Light shafts of a camera, as far as a picture of it asks them. */
export interface CameraShafts {
  readonly camera: Camera
  /** The camera's view of the air in the light. */
  readonly view: ViewNodes
  readonly shadowedAir: ShadowedAir
  readonly steps: ShaftSteps
  /** True if there are shadows to be drawn, as of the last `prepare`. */
  readonly isActive: boolean
  /** Grows whenever its shader changes. */
  readonly version: number
  prepare(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void
  update(view: AtmosphereView): void
  /** Takes lost light from light, where shafts are on. */
  subtract(light: Vec4, lost: () => Vec4): Vec4
}

/**
 * Light shafts up to the depth of a picture, for post effects: marched for every second pixel of every
 * second row, then taken from the four around a pixel that are at its depth.
 */
export class ScreenShafts implements SkyLayer {
  readonly target: RenderTarget
  readonly #shafts: CameraShafts
  readonly #rays: DepthRays
  /** Size of the picture, and of the target [pixels]. */
  readonly #size = vector2()
  readonly #halfSize = vector2()
  readonly #lost: TextureNode
  #pass: FragmentPass | null = null
  /** Version of the shafts that the pass is of. */
  #compiled = 0

  constructor(shafts: CameraShafts, depthNode: Node) {
    this.#shafts = shafts
    this.#rays = new DepthRays(depthNode, shafts.camera)
    this.target = tableTarget('Welkin.LightShafts', 1, 1, 1, NearestFilter)
    this.#lost = texture(this.target.texture)
  }

  prepare(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void {
    const shafts = this.#shafts
    shafts.prepare(renderer, view, frame)
    const { width, height } = renderer.getRenderTarget() ?? renderer.getDrawingBufferSize(_size)
    this.#size.value.set(Math.max(width, 1), Math.max(height, 1))
    this.#halfSize.value.copy(this.#size.value).multiplyScalar(0.5).ceil()
    this.target.setSize(this.#halfSize.value.x, this.#halfSize.value.y)
    if (!shafts.isActive) return
    // What is drawn here and now reads the view.
    shafts.view.update(view)
    if (this.#compiled !== shafts.version) this.#pass?.dispose()
    if (this.#compiled !== shafts.version || this.#pass === null) {
      this.#pass = new FragmentPass('Welkin.LightShafts', this.#march())
      this.#compiled = shafts.version
    }
    this.#pass.render(renderer, this.target)
  }

  update(view: AtmosphereView): void {
    this.#shafts.update(view)
  }

  glow(_: SkyRay, without: Vec4): Vec4 {
    return this.#shafts.subtract(without, this.#sample)
  }

  inScatter(_: PointRay, without: Vec4): Vec4 {
    return this.#shafts.subtract(without, this.#sample)
  }

  #march(): Vec4 {
    const shafts = this.#shafts
    return Fn(({ renderer }): Vec4 => {
      const pixel = uv().mul(this.#halfSize).floor().toConst() as unknown as Vec2
      const at = this.#uvOf(pixel)
      const { position, isSky } = this.#rays.at(renderer, at)
      const { view } = shafts
      const offset = view.toMapped(position).toConst()
      const distance = isSky.select(1e10, offset.length()).toConst()
      const towards = offset.normalize().toConst()
      const cosView = towards.dot(view.up).clamp(-1, 1).toConst() as Float
      const cosViewLight = towards.dot(view.lightDirection).toConst() as Float
      const ray = { direction: towards, cosView, cosViewLight, distance }
      return lostLight(view, shafts.shadowedAir, ray, shafts.steps, staggered(pixel)).mul(
        RADIANCE_SCALE
      )
    })()
  }

  /** Place in the picture of the pixel that is marched for one of the target. */
  #uvOf(pixel: Vec2): Vec2 {
    return pixel.mul(2).add(0.5).div(this.#size).toConst()
  }

  /** Light that the pixel has lost: the mean of four, which have samples in all places of their steps. */
  readonly #sample = (): Vec4 =>
    Fn(({ renderer }): Vec4 => {
      const at = uv() as unknown as Vec2
      const depth = this.#rays.viewDepth(renderer, at)
      const first = at.mul(this.#size).mul(0.5).floor().toConst() as Vec2
      const sum = vec4(0).toVar()
      const weights = float(0).toVar()
      for (const i of [0, 1, 2, 3]) {
        const pixel = first
          .add(vec2(i & 1, i >> 1))
          .min(this.#halfSize.sub(1))
          .toConst() as Vec2
        const other = this.#rays.viewDepth(renderer, this.#uvOf(pixel))
        const apart = log2(depth.div(other)).abs()
        const weight = apart
          .sub(OTHER_DEPTH)
          .div(SAME_DEPTH - OTHER_DEPTH)
          .clamp(STRANGER, 1)
          .toConst() as Float
        sum.addAssign(sampleLevel0(this.#lost, pixel.add(0.5).div(this.#halfSize)).mul(weight))
        weights.addAssign(weight)
      }
      return sum.div(weights.mul(RADIANCE_SCALE))
    })()

  /** Frees the target. */
  dispose(): void {
    this.target.dispose()
    this.#pass?.dispose()
    this.#pass = null
  }
}
