import { NearestFilter, RGFormat, Vector2 } from 'three'
import type { Camera, RenderTarget } from 'three'
import { Fn, If, float, log2, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Node, NodeFrame, Renderer, TextureNode, UniformNode } from 'three/webgpu'
import { linearSRGB } from '../air/tsl/color'
import { rayLimits } from '../skyVolume/tsl/rayLimits'
import { FragmentPass, tableTarget, twoOutputs, type Outputs } from '../tables/FragmentPass'
import { RADIANCE_SCALE } from '../tables/tableSizes'
import { sampleLevel0, type Bool, type Float, type Vec2, type Vec3, type Vec4 } from '../tsl-types'
import { number, vector2 } from '../uniforms'
import type { ScreenShadows, Veil } from '../view/AirShadows'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { PointRay, SkyRay } from '../view/SkyLayer'
import type { ViewNodes } from '../view/ViewNodes'
import { lostLight, staggered, type ShadowedAir, type ShaftSteps } from './tsl/lostLight'
import { DepthRays } from '../view/DepthRays'

/** Octaves of depth by which pixels may differ and still share light, and by which they share none. */
const SAME_DEPTH = 0.2
const OTHER_DEPTH = 0.6

/** Weight of pixels of another depth, where there are no others. */
const STRANGER = 1e-3

/** Distance in which about half of the light of a level ray is scattered [m]. */
const HAZE = 30_000

/** Most by which lost light grows with the distance from one pixel to the next, as a factor. */
const MOST_MORE = 2

/** Light of the air up to a distance, as a part of all. */
const lightUpTo = (distance: Float): Float => distance.div(distance.add(HAZE))

/** Distances that stand for the sky and for the planet where it was not drawn [m]. */
const FAR = 1e10
const PLANET = 1e8

/** Part of the light from behind a veil that is not worth samples. */
const OPAQUE = 0.01

/** What is seen in a pixel: see `ScreenShafts`. */
interface Seen {
  offset: Vec3
  distance: Float
  isSky: Bool
  light: Float
}

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
  /** True if a veil is drawn, by whose node shafts are. */
  readonly isVeiled: boolean
  /** True if materials draw the shafts themselves. */
  readonly isForward: boolean
  /** Part of the light that air in shadow loses; 0 where shafts are off. */
  readonly strengthNow: UniformNode<'float', number>
  prepare(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void
  update(view: AtmosphereView): void
}

/**
 * Light shafts up to the depth of a picture, for post effects: marched for every second pixel of every
 * second row, then taken from the four around a pixel that are at its depth.
 *
 * Of a picture with a veil the light before it counts, and the light behind it as far as it passes: so the light
 * is taken from the picture of both, at once.
 */
export class ScreenShafts implements ScreenShadows {
  readonly veil: Veil | undefined
  readonly target: RenderTarget
  readonly #shafts: CameraShafts
  readonly #rays: DepthRays
  /** Size of the picture, and of the target [pixels]. */
  readonly #size = vector2()
  readonly #halfSize = vector2()
  readonly #lost: TextureNode
  /** Of its pixels: binary logarithm of the distance [m], and the light of the air up to there as a part of all. */
  readonly #distances: TextureNode
  #pass: FragmentPass | null = null
  /** Version of the shafts that the pass is of. */
  #compiled = 0
  /** `strengthNow`; 0 while the node of a veil draws the shafts. */
  readonly #strength = number()
  /** 1 if what is behind the veil has shafts already. */
  readonly #isForward = number()

  constructor(shafts: CameraShafts, depthNode: Node, veil?: Veil) {
    this.veil = veil
    this.#shafts = shafts
    this.#rays = new DepthRays(depthNode, shafts.camera)
    this.target = tableTarget('Welkin.LightShafts', 1, 1, 2, NearestFilter)
    const [lost, distances] = this.target.textures
    distances.format = RGFormat
    this.#lost = texture(lost)
    this.#distances = texture(distances)
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

  glow(_: SkyRay, light: Vec4): Vec4 {
    return this.#subtract(light)
  }

  inScatter(_: PointRay, light: Vec4): Vec4 {
    return this.#subtract(light)
  }

  /** True if the node of a veil draws the shafts, so that this one has no part in its shader. */
  get #isElsewhere(): boolean {
    return this.veil === undefined && this.#shafts.isVeiled
  }

  #subtract(light: Vec4): Vec4 {
    if (this.#isElsewhere) return light
    return without(light, this.#strength, this.#shafts.view, this.#sample)
  }

  dim(color: Vec3): Vec3 {
    const { view } = this.#shafts
    const left = color.toVar()
    If(this.#strength.greaterThan(0), () => {
      const lost = this.#sample().mul(view.source.irradiance).mul(this.#strength).toConst()
      // Clouds may also give light: a colour has no negative parts, so these are apart.
      const [less, more] = [lost.max(0), lost.negate().max(0)]
      const { uniforms } = view.air
      left.assign(left.sub(linearSRGB(uniforms, less)).add(linearSRGB(uniforms, more)).max(0))
    })
    return left
  }

  /** Part of the light from a distance that the picture has, and the distance beyond which it has none [m]. */
  #seen(at: Vec2): { seenFrom?: (distance: Float) => Float; most: Float } {
    if (this.veil === undefined) return { most: float(FAR) }
    const { distance, transmittance } = this.veil.seenAt(at)
    // Behind the veil the shadows of materials are dimmed with them.
    const before = transmittance.mul(this.#isForward).oneMinus().toConst() as Float
    const behind = transmittance.mul(this.#isForward.oneMinus()).toConst() as Float
    return {
      seenFrom: from => from.lessThan(distance).select(before, behind),
      most: behind.greaterThan(OPAQUE).select(FAR, distance).toConst()
    }
  }

  #march(): Outputs {
    const shafts = this.#shafts
    return twoOutputs(renderer => {
      const pixel = uv().mul(this.#halfSize).floor().toConst() as unknown as Vec2
      const at = this.#uvOf(pixel)
      const { view } = shafts
      const { offset, distance: drawn, isSky, light } = this.#seenAlong(renderer, at)
      const jitter = staggered(pixel)
      const { seenFrom, most } = this.#seen(at)
      const distance = isSky.select(FAR, drawn).min(most).toConst()
      const towards = offset.normalize().toConst()
      const cosView = towards.dot(view.up).clamp(-1, 1).toConst() as Float
      const cosViewLight = towards.dot(view.lightDirection).toConst() as Float
      const ray = { direction: towards, cosView, cosViewLight, distance, seenFrom }
      const lost = lostLight(view, shafts.shadowedAir, ray, shafts.steps, jitter)
      return [lost.mul(RADIANCE_SCALE), vec4(log2(drawn), light, 0, 0)]
    })
  }

  /**
   * Displacement of what is seen and its distance: where nothing was drawn that of sky, or of the planet [m]; and
   * the light of the air up to there. It ends at the planet's surface, behind which ground may lie.
   */
  #seenAlong(renderer: Renderer, at: Vec2): Seen {
    const { position, isSky } = this.#rays.at(renderer, at)
    const { view } = this.#shafts
    const offset = view.toMapped(position).toConst()
    const distance = offset.length().max(1e-3).toConst()
    const cosView = offset.div(distance).dot(view.up).toConst()
    const limits = rayLimits(view.viewpoint, cosView)
    const seen = isSky.select(limits.hitsGround.select(PLANET, FAR), distance).toConst()
    const light = lightUpTo(seen.min(limits.start.add(limits.length))).toConst() as Float
    return { offset, distance: seen, isSky, light }
  }

  /** Place in the picture of the pixel that is marched for one of the target. */
  #uvOf(pixel: Vec2): Vec2 {
    return pixel.mul(2).add(0.5).div(this.#size).toConst()
  }

  /** Light that the pixel has lost: the mean of four, which have samples in all places of their steps. */
  readonly #sample = (): Vec4 =>
    Fn(({ renderer }): Vec4 => {
      const at = uv() as unknown as Vec2
      const { distance, light } = this.#seenAlong(renderer, at)
      const distanceLog = log2(distance).toConst()
      const first = at.mul(this.#size).mul(0.5).floor().toConst() as Vec2
      const sum = vec4(0).toVar()
      const weights = float(0).toVar()
      for (const i of [0, 1, 2, 3]) {
        const pixel = first
          .add(vec2(i & 1, i >> 1))
          .min(this.#halfSize.sub(1))
          .toConst() as Vec2
        const place = pixel.add(0.5).div(this.#halfSize).toConst() as Vec2
        const other = sampleLevel0(this.#distances, place).toConst()
        const apart = distanceLog.sub(other.x).abs()
        const weight = apart
          .sub(OTHER_DEPTH)
          .div(SAME_DEPTH - OTHER_DEPTH)
          .clamp(STRANGER, 1)
          .toConst() as Float
        // As if light were lost evenly: rows of level ground are not alike, nor is what has none of its depth around.
        const fewer = light.div(other.y.max(1e-7)).min(MOST_MORE)
        const lost = sampleLevel0(this.#lost, place)
        sum.addAssign(lost.mul(weight.mul(fewer)))
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
