import { NearestFilter, Vector2 } from 'three'
import type { Camera, RenderTarget } from 'three'
import { Fn, If, float, log2, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Node, NodeFrame, Renderer, TextureNode, UniformNode } from 'three/webgpu'
import { linearSRGB } from '../air/tsl/color'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { rayLimits } from '../skyVolume/tsl/rayLimits'
import { radianceBetween, sampleVolume } from '../skyVolume/tsl/skyVolume'
import { sampleLevel0, type Float, type Vec2, type Vec3, type Vec4 } from '../tsl-types'
import { number, vector2 } from '../uniforms'
import type { ScreenShadows, ForegroundLayer } from '../view/AirShadows'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { PointRay, SkyRay } from '../view/SkyLayer'
import type { ViewNodes } from '../view/ViewNodes'
import {
  lostLight,
  staggered,
  type ShadowedAir,
  type ShaftRay,
  type ShaftSteps
} from './tsl/lostLight'
import { DepthRays } from '../view/DepthRays'

/** Octaves of depth by which pixels may differ and still share light, and by which they share none. */
const SAME_DEPTH = 0.2
const OTHER_DEPTH = 0.6

/** Least weight in the bilateral upsampling: that of pixels of another depth. */
const MIN_WEIGHT = 1e-3

/**
 * Range of the part of its light that a pixel may lose: less than none, as clouds reflect light, and more than all, as
 * its light is from a table.
 */
const PARTS = [-20, 4] as const

/** Distances that stand for the sky and for the planet where it was not drawn [m]. */
const FAR = 1e10
const PLANET = 1e9

/** Part of the light from behind a foreground layer that is not worth samples. */
const OPAQUE = 0.01

const _size = new Vector2()

/** Light less what {@link lostLight} gives, and no less than none, where shafts are on. */
export function without(
  light: Vec4,
  strength: Float,
  { source }: ViewNodes,
  lost: () => Vec4
): Vec4 {
  const left = light.toVar()
  If(strength.greaterThan(0), () => {
    left.subAssign(lost().mul(source.irradiance).mul(strength).min(left))
  })
  return left
}

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
  /** True if a foreground layer is drawn, by whose node shafts are. */
  readonly hasForeground: boolean
  /** True if materials draw the shafts themselves. */
  readonly isForward: boolean
  /** Part of the light that air in shadow loses; 0 where shafts are off. */
  readonly strengthNow: UniformNode<'float', number>
  prepare(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void
  update(view: AtmosphereView): void
  /** Called by a picture's shafts that are disposed of. */
  forget(screen: ScreenShafts): void
}

/**
 * Light shafts up to the depth of a picture, for post effects: marched for every second pixel of every
 * second row, then taken from the four around a pixel that are at its depth.
 *
 * Of a picture with a foreground layer the light before it counts, and the light behind it as far as it passes: so the light
 * is taken from the picture of both, at once.
 */
export class ScreenShafts implements ScreenShadows {
  readonly foreground: ForegroundLayer | undefined
  readonly target: RenderTarget
  readonly #shafts: CameraShafts
  readonly #rays: DepthRays
  /** Size of the picture, and of the target [pixels]. */
  readonly #size = vector2()
  readonly #halfSize = vector2()
  readonly #parts: TextureNode
  #pass: FragmentPass | null = null
  /** Version of the shafts that the pass is of. */
  #compiled = 0
  /** `strengthNow`; 0 while the node of a foreground layer draws the shafts. */
  readonly #strength = number()
  /** 1 if what is behind the foreground has shafts already. */
  readonly #isForward = number()

  constructor(shafts: CameraShafts, depthNode: Node, foreground?: ForegroundLayer) {
    this.foreground = foreground
    this.#shafts = shafts
    this.#rays = new DepthRays(depthNode, shafts.camera)
    this.target = tableTarget('Welkin.LightShafts', 1, 1, 1, NearestFilter)
    this.#parts = texture(this.target.texture)
  }

  prepare(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void {
    const shafts = this.#shafts
    if (this.#isElsewhere) return
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
    const shafts = this.#shafts
    shafts.update(view)
    this.#strength.value = this.#isElsewhere ? 0 : shafts.strengthNow.value
    this.#isForward.value = shafts.isForward ? 1 : 0
  }

  glow({ direction, cosView, hitsGround }: SkyRay, light: Vec4): Vec4 {
    const distance = hitsGround.select(PLANET, FAR).toConst() as Float
    const cosViewLight = direction.dot(this.#shafts.view.lightDirection).toConst() as Float
    return this.#subtract(light, distance, () =>
      this.#litAir({ direction, cosView, cosViewLight, distance })
    )
  }

  inScatter({ direction, distance, segment }: PointRay, light: Vec4): Vec4 {
    const { air, volume, viewpoint, lightDirection } = this.#shafts.view
    const cosViewLight = direction.dot(lightDirection).toConst() as Float
    return this.#subtract(light, distance, () =>
      radianceBetween(air.uniforms, volume, viewpoint, segment, cosViewLight)
    )
  }

  /** True if the node of a foreground layer draws the shafts, so that this one has no part in its shader. */
  get #isElsewhere(): boolean {
    return this.foreground === undefined && this.#shafts.hasForeground
  }

  /** @param litAir - Light of the air up to the distance [m] without shadows [1/sr]. */
  #subtract(light: Vec4, distance: Float, litAir: () => Vec4): Vec4 {
    if (this.#isElsewhere) return light
    const { view } = this.#shafts
    return without(light, this.#strength, view, () => this.#partLost(distance).mul(litAir()))
  }

  dim(color: Vec3): Vec3 {
    const { view } = this.#shafts
    const left = color.toVar()
    If(this.#strength.greaterThan(0), () => {
      const unlit = Fn(({ renderer }): Vec4 => {
        const ray = this.#rayTo(renderer, uv())
        return this.#partLost(ray.distance).mul(this.#litAir(ray))
      })()
      const lost = unlit.mul(view.source.irradiance).mul(this.#strength).toConst()
      // Clouds may also give light: a colour has no negative parts, so these are apart.
      const [less, more] = [lost.max(0), lost.negate().max(0)]
      const { uniforms } = view.air
      const taken = linearSRGB(uniforms, less).min(left)
      left.assign(left.sub(taken).add(linearSRGB(uniforms, more)).max(0))
    })
    return left
  }

  /** Part of the light from a distance that the picture has, and the distance beyond which it has none [m]. */
  #seen(at: Vec2): { seenFrom?: (distance: Float) => Float; most: Float } {
    if (this.foreground === undefined) return { most: float(FAR) }
    const { distance, transmittance } = this.foreground.seenAt(at)
    // Behind the foreground the shadows of materials are dimmed with them.
    const before = transmittance.mul(this.#isForward).oneMinus().toConst() as Float
    const behind = transmittance.mul(this.#isForward.oneMinus()).toConst() as Float
    return {
      seenFrom: from => from.lessThan(distance).select(before, behind),
      most: behind.greaterThan(OPAQUE).select(FAR, distance).toConst()
    }
  }

  #march(): Vec4 {
    const { view, shadowedAir, steps } = this.#shafts
    return Fn(({ renderer }): Vec4 => {
      const pixel = uv().mul(this.#halfSize).floor().toConst() as unknown as Vec2
      const at = this.#uvOf(pixel)
      const ray = this.#rayTo(renderer, at)
      const { seenFrom, most } = this.#seen(at)
      const distance = ray.distance.min(most).toConst() as Float
      const jitter = staggered(pixel)
      const lost = lostLight(view, shadowedAir, { ...ray, distance, seenFrom }, steps, jitter)
      return lost.div(this.#litAir(ray).max(1e-12)).clamp(...PARTS)
    })()
  }

  /** View ray to what is seen: to the sky, or the planet, where nothing was drawn. */
  #rayTo(renderer: Renderer, at: Vec2): ShaftRay {
    const { position, isSky } = this.#rays.at(renderer, at)
    const { view } = this.#shafts
    const offset = view.toMapped(position).toConst()
    const length = offset.length().max(1e-3).toConst()
    const direction = offset.div(length).toConst()
    const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
    const cosViewLight = direction.dot(view.lightDirection).toConst() as Float
    const background = cosView.lessThan(view.viewpoint.cosHorizon).select(PLANET, FAR)
    const distance = isSky.select(background, length).toConst() as Float
    return { direction, cosView, cosViewLight, distance }
  }

  /** Light of the air on a ray without shadows [1/sr]. */
  #litAir({ cosView, cosViewLight, distance }: ShaftRay): Vec4 {
    const { air, volume, viewpoint } = this.#shafts.view
    const limits = rayLimits(viewpoint, cosView)
    return sampleVolume(air.uniforms, volume, viewpoint, cosView, cosViewLight, limits, distance)
      .radiance
  }

  /** Place in the picture of the pixel that is marched for one of the target. */
  #uvOf(pixel: Vec2): Vec2 {
    return pixel.mul(2).add(0.5).div(this.#size).toConst()
  }

  /**
   * Part of the light of its air that the pixel has lost: the mean of four around, which have samples in all places
   * of their steps. So a pixel whose depth none of them has loses no more than it has.
   *
   * @param distance - Distance of what is seen in it [m].
   */
  #partLost(distance: Float): Vec4 {
    return Fn(({ renderer }): Vec4 => {
      const first = uv().mul(this.#size).mul(0.5).floor().toConst() as unknown as Vec2
      const sum = vec4(0).toVar()
      const weights = float(0).toVar()
      for (const i of [0, 1, 2, 3]) {
        const pixel = first
          .add(vec2(i & 1, i >> 1))
          .min(this.#halfSize.sub(1))
          .toConst() as Vec2
        const other = this.#rayTo(renderer, this.#uvOf(pixel)).distance
        const apart = log2(distance.div(other)).abs()
        const weight = apart
          .sub(OTHER_DEPTH)
          .div(SAME_DEPTH - OTHER_DEPTH)
          .clamp(MIN_WEIGHT, 1)
          .toConst() as Float
        sum.addAssign(sampleLevel0(this.#parts, pixel.add(0.5).div(this.#halfSize)).mul(weight))
        weights.addAssign(weight)
      }
      return sum.div(weights)
    })()
  }

  /** Takes them out of the shafts of their camera. */
  dispose(): void {
    this.#shafts.forget(this)
    this.free()
  }

  /** Frees the target, which is made again where they are drawn. */
  free(): void {
    this.target.dispose()
    this.#pass?.dispose()
    this.#pass = null
  }
}
