import { Vector2 } from 'three'
import type { RenderTarget } from 'three'
import { Fn, If, bool, float, log2, screenUV, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Node, NodeFrame, Renderer, TextureNode } from 'three/webgpu'
import { linearSRGB } from '../air/tsl/color'
import { densities, extinction } from '../air/cpu/medium'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { rayLimits } from '../skyVolume/tsl/rayLimits'
import { sampleVolume, type MediumSegment } from '../skyVolume/tsl/skyVolume'
import { RADIANCE_SCALE } from '../tables/tableSizes'
import {
  loop,
  sampleLevel0,
  type Bool,
  type Float,
  type Vec2,
  type Vec3,
  type Vec4
} from '../tsl-types'
import { number, vector2 } from '../uniforms'
import type { ScreenShadows, ForegroundLayer } from '../view/AirShadows'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { LayerRay, SkyLayer } from '../view/SkyLayer'
import { isShadowed } from './tsl/lostInMedia'
import { lostLight, staggered } from './tsl/lostLight'
import type { CameraShafts } from './CameraShafts'
import type { ShaftRay } from './tsl/shadowsAlong'
import { distanceOf, FAR, without } from './tsl/without'
import { DepthRays } from '../view/DepthRays'

/**
 * Octaves of depth by which pixels may differ and still share light, and by which they share none. Greater: halos at
 * silhouettes; smaller: the march's pixels show on slopes (*Towers in haze*).
 */
const SAME_DEPTH = 0.35
const OTHER_DEPTH = 0.8

/** Least weight in the bilateral upsampling: that of pixels of another depth. */
const MIN_WEIGHT = 1e-3

/** Greatest light that the target keeps: half floats hold a little more; and scale of light in it. */
const MOST = 6e4
const LIGHT_SCALE = RADIANCE_SCALE / 8

/** Part of light from behind a layer that is not worth samples. Greater: shafts end at thin clouds (*Below a broken deck*). */
const OPAQUE = 0.01

const _size = new Vector2()

/**
 * Light shafts up to the depth of a picture, for post effects: marched for a grid of pixels, then taken from those around a
 * pixel that are at its depth.
 *
 * With a foreground layer, light in front of it counts in full, and light behind it as far as it passes: lost light is then
 * taken from the picture of both, at once.
 */
export class ScreenShafts implements ScreenShadows {
  readonly foreground: ForegroundLayer | undefined
  readonly target: RenderTarget
  readonly #shafts: CameraShafts
  /** True for a mesh of air, whose rays end at the planet or nowhere. */
  readonly #isMesh: boolean
  readonly #rays: DepthRays
  /** Size of the picture, and of either half of the target [pixels]. */
  readonly #size = vector2()
  readonly #gridSize = vector2()
  /** Reciprocal of the pixels of the picture from one that is marched to the next. */
  readonly #density = number(1)
  /** Texel of the target in texture coordinates. */
  readonly #texelSize = vector2()
  /** Longest mean free path in the air at the camera [m]. Shorter: dark pixels along the horizon (*Ridge at sunrise*). */
  readonly #freePath = number(1)
  /** 1 if there is a medium, such as fog, in the light of the shafts. */
  readonly #hasMedia = number()
  readonly #texels: TextureNode
  #pass: FragmentPass | null = null
  /** Version of the shafts that the pass is of. */
  #compiled = 0
  /** `strengthNow`; 0 while the node of a foreground layer draws the shafts. */
  readonly #strength = number()
  /** 1 if what is behind the foreground has shafts already. */
  readonly #isForward = number()

  constructor(shafts: CameraShafts, depthNode: Node | null, foreground?: ForegroundLayer) {
    this.foreground = foreground
    this.#shafts = shafts
    this.#isMesh = depthNode === null
    this.#rays = new DepthRays(depthNode ?? float(0.5), shafts.camera)
    this.target = tableTarget('Welkin.LightShafts', 1, 1)
    this.#texels = texture(this.target.texture)
  }

  prepare(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void {
    const shafts = this.#shafts
    if (this.#isElsewhere) return
    shafts.prepare(renderer, view, frame)
    const { width, height } = renderer.getRenderTarget() ?? renderer.getDrawingBufferSize(_size)
    this.#size.value.set(Math.max(width, 1), Math.max(height, 1))
    this.#density.value = 1 / shafts.spacing
    this.#gridSize.value.copy(this.#size.value).divideScalar(shafts.spacing).ceil()
    const { x, y } = this.#gridSize.value
    this.target.setSize(2 * x, y)
    this.#texelSize.value.set(0.5 / x, 1 / y)
    if (!shafts.isActive) return
    // What is drawn here and now reads the view, and media in it.
    shafts.view.update(view)
    const { parameters, layers } = shafts.view.atmosphere
    const air = extinction(parameters, densities(parameters, Math.max(view.height, 0)))
    const media = layers.filter(isShadowed)
    for (const layer of media) layer.update?.(view)
    const fog = media.reduce((sum, { extinction = 0 }) => sum + extinction, 0)
    const isFog = (layer: SkyLayer): boolean => 'shadowed' in layer && layer.extinction !== 0
    this.#hasMedia.value = Number(media.some(isFog))
    this.#freePath.value = 1 / (Math.max(Math.min(...air), 1e-12) + fog)
    if (this.#compiled !== shafts.version) this.#pass?.dispose()
    if (this.#compiled !== shafts.version || this.#pass === null) {
      this.#pass = new FragmentPass('Welkin.LightShafts', this.#draw())
      this.#compiled = shafts.version
    }
    this.#pass.render(renderer, this.target)
  }

  update(view: AtmosphereView): void {
    this.#shafts.update(view)
    this.#strength.value = this.#isElsewhere ? 0 : this.#shafts.strengthNow.value
    this.#isForward.value = Number(this.#shafts.isForward)
  }

  medium(ray: LayerRay | null, air: MediumSegment): MediumSegment {
    const { view } = this.#shafts
    if (ray === null) return without(air, this.#strength, view, () => this.#lostHere())
    if (this.#isElsewhere) return air
    const { direction, cosView, ...to } = ray
    const cosViewLight = direction.dot(view.lightDirection).toConst() as Float
    return without(air, this.#strength, view, () =>
      this.#lostTo({ direction, cosView, cosViewLight, distance: distanceOf(to) })
    )
  }

  drawIn(frame: NodeFrame, sun: object): void {
    const { view, camera } = this.#shafts
    const { atmosphere, source } = view
    const isTheirs = frame.camera === camera && sun === atmosphere && source === atmosphere.sun
    const seen = isTheirs ? view.prepare(frame) : undefined
    this.#strength.value = 0
    if (seen === undefined) return
    this.prepare(frame.renderer!, seen, frame)
    this.update(seen)
  }

  /** Place of a fragment in the picture: meshes have coordinates of their own. */
  get #place(): Vec2 {
    return this.#isMesh ? screenUV : uv()
  }

  /** Light that the pixel loses, for unit irradiance [1/sr]. */
  #lostHere(): Vec4 {
    return Fn(({ renderer }): Vec4 => this.#lostTo(this.#rayTo(renderer, this.#place)))()
  }

  /** True if the node of a foreground layer draws the shafts, so that this one has no part in its shader. */
  get #isElsewhere(): boolean {
    return this.foreground === undefined && this.#shafts.hasForeground
  }

  dim(color: Vec3): Vec3 {
    const { view } = this.#shafts
    const left = color.toVar()
    If(this.#strength.greaterThan(0), () => {
      const lost = this.#lostHere().mul(view.source.irradiance).mul(this.#strength).toConst()
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

  /**
   * A texel of the target. In its left half light; in its right one log₂ of the distance, the least and the greatest
   * one of the nine pixels around, and the light that there is.
   */
  #draw(): Vec4 {
    return Fn(({ renderer }): Vec4 => {
      const pixel = uv().div(this.#texelSize).floor().toVar()
      const result = vec4(0).toVar()
      If(pixel.x.lessThan(this.#gridSize.x), () => {
        result.assign(this.#march(renderer, pixel))
      }).Else(() => {
        pixel.x.subAssign(this.#gridSize.x)
        const rayAt = (aside: Vec2): ShaftRay => {
          const next = pixel.add(aside).clamp(vec2(0), this.#gridSize.sub(1)).toConst() as Vec2
          return this.#rayTo(renderer, this.#uvOf(next))
        }
        const ray = rayAt(vec2(0))
        const own = log2(ray.distance).toConst()
        result.assign(vec4(own, own, own, this.#litAir(ray)))
        loop('neighbor', 9, index => {
          const row = float(index).div(3).floor().toConst()
          const aside = vec2(float(index).sub(row.mul(3)), row).sub(1) as Vec2
          const other = log2(rayAt(aside).distance).toConst()
          result.y.assign(result.y.min(other))
          result.z.assign(result.z.max(other))
        })
      })
      return result
    })()
  }

  /** Light that the ray of a pixel of the target loses, as the target keeps it. */
  #march(renderer: Renderer, pixel: Vec2): Vec4 {
    const { view, shadowedAir, steps } = this.#shafts
    const at = this.#uvOf(pixel)
    const ray = this.#rayTo(renderer, at)
    const { seenFrom, most } = this.#seen(at)
    const distance = ray.distance.min(most).toConst() as Float
    const jitter = staggered(pixel)
    const lost = lostLight(view, shadowedAir, { ...ray, distance, seenFrom }, steps, jitter)
    return lost.mul(LIGHT_SCALE).div(this.#growth(ray.distance)).clamp(-MOST, MOST)
  }

  /**
   * Growth of the light of air with distance, about as that of even air: light over it is about the same for pixels
   * whose distances differ a little, and is what they share.
   */
  #growth(distance: Float): Float {
    return distance.div(distance.add(this.#freePath))
  }

  /** View ray to what is seen: to the sky, or the planet, where nothing was drawn. */
  #rayTo(renderer: Renderer, at: Vec2): ShaftRay {
    const { position, isSky } = this.#isMesh
      ? { position: this.#rays.position(renderer, at, float(0.5)), isSky: bool(true) as Bool }
      : this.#rays.at(renderer, at)
    const { view } = this.#shafts
    const offset = view.toMapped(position).toConst()
    const length = offset.length().max(1e-3).toConst()
    const direction = offset.div(length).toConst()
    const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
    const cosViewLight = direction.dot(view.lightDirection).toConst() as Float
    const hitsGround = cosView.lessThan(view.viewpoint.cosHorizon) as Bool
    const distance = isSky.select(distanceOf({ hitsGround }), length).toConst() as Float
    return { direction, cosView, cosViewLight, distance }
  }

  /** Light of the air on a ray without shadows, in the mean over wavelengths, as the target keeps light. */
  #litAir(ray: ShaftRay): Float {
    const { cosView, cosViewLight, distance } = ray
    const { air, volume, viewpoint } = this.#shafts.view
    const limits = rayLimits(viewpoint, cosView)
    const at = [cosView, cosViewLight, limits, distance] as const
    const { radiance } = sampleVolume(air.uniforms, volume, viewpoint, ...at)
    const scale = this.#growth(distance)
      .reciprocal()
      .mul(LIGHT_SCALE / 4)
    const light = radiance.toVar()
    If(this.#hasMedia.greaterThan(0), () => {
      const media = this.#shafts.shadowedAir.mediaOn({ view: this.#shafts.view, ...ray })
      for (const { transmittance, singleScattered } of media) {
        light.assign(light.mul(transmittance).add(singleScattered))
      }
    })
    return light.dot(vec4(scale)).clamp(1e-5, MOST).toConst()
  }

  /** Place in the picture of the pixel that is marched for one of the target. */
  #uvOf(pixel: Vec2): Vec2 {
    return pixel.div(this.#density).add(0.5).div(this.#size).toConst()
  }

  /**
   * Light that a pixel loses, for unit irradiance [1/sr]: from nine around it, of which any four that touch have
   * samples in all places of their steps; where those are of several depths, from the four nearest.
   *
   * @param ray - View ray to what is seen in it.
   */
  #lostTo(ray: ShaftRay): Vec4 {
    const size = this.#gridSize
    const place = this.#place.mul(this.#size).sub(0.5).mul(this.#density).toConst() as Vec2
    const read = (texel: Vec2): Vec4 =>
      sampleLevel0(this.#texels, texel.mul(this.#texelSize)).toConst()
    const lightAt = (texel: Vec2): Vec4 => read(texel.min(size.sub(0.5)))
    const own = log2(ray.distance).toConst() as Float
    const nearest = place.add(0.5).floor().min(size.sub(1)).toConst() as Vec2
    const { y: least, z: greatest } = read(nearest.add(vec2(size.x, 0)).add(0.5))
    const lost = vec4(0).toVar()
    If(own.sub(least).max(greatest.sub(own)).lessThan(SAME_DEPTH), () => {
      // The means of all fours, between them: weights 1 − w, 1, w over 2 in both axes, by four reads.
      const after = place.sub(nearest).mul(0.5).add(0.5).toConst() as Vec2
      const before = after.oneMinus().toConst() as Vec2
      const low = nearest.sub(0.5).add(vec2(0.25).div(before)).toConst() as Vec2
      const high = nearest.add(1.5).sub(vec2(0.25).div(after)).toConst() as Vec2
      const upper = lightAt(low)
        .mul(before.x)
        .add(lightAt(vec2(high.x, low.y)).mul(after.x))
      const lower = lightAt(vec2(low.x, high.y)).mul(before.x).add(lightAt(high).mul(after.x))
      const sum = upper.mul(before.y).add(lower.mul(after.y))
      lost.assign(sum)
    }).Else(() => {
      const first = place.floor().toConst() as Vec2
      const weights = float(0).toVar()
      const light = this.#litAir(ray)
      loop('corner', 4, index => {
        const row = float(index).div(2).floor().toConst()
        const corner = first
          .add(vec2(float(index).sub(row.mul(2)), row))
          .min(size.sub(1))
          .add(0.5)
        const other = read(corner.add(vec2(size.x, 0)))
        const apart = other.x.sub(own).abs()
        const weight = apart
          .sub(OTHER_DEPTH)
          .div(SAME_DEPTH - OTHER_DEPTH)
          .clamp(MIN_WEIGHT, 1)
        // Of light that others have more of, or less, the same part.
        lost.addAssign(read(corner).mul(weight.mul(light.div(other.w))))
        weights.addAssign(weight)
      })
      lost.divAssign(weights)
    })
    return lost.mul(this.#growth(ray.distance)).div(LIGHT_SCALE)
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
