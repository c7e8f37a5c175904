import { Vector2, type OrthographicCamera } from 'three'
import { Fn, If, bool, float, mix, screenUV, uv, vec3 } from 'three/tsl'
import type { Node, NodeFrame, Renderer } from 'three/webgpu'
import { unclampedSRGB } from '../air/tsl/color'
import { densities, extinction } from '../air/cpu/medium'
import { rayLimits } from '../skyVolume/tsl/rayLimits'
import { sampleVolume } from '../skyVolume/tsl/skyVolume'
import type { Bool, Float, Vec2, Vec3, Vec4 } from '../tsl-types'
import { number } from '../uniforms'
import type { ScreenShadows, ForegroundLayer } from '../view/AirShadows'
import type { AtmosphereView } from '../view/AtmosphereView'
import { isShadowed } from './tsl/lostInMedia'
import { lostLight, staggered } from './tsl/lostLight'
import type { CameraShafts } from './CameraShafts'
import { spacingIn } from './quality'
import { LostLightGrid, THIN_HEIGHT, type LostLight, type SeenAir } from './LostLightGrid'
import { rarityThrough } from './tsl/rarity'
import type { ShaftRay } from './tsl/shadowsAlong'
import { distanceOf } from './tsl/without'
import { DepthRays } from '../view/DepthRays'
import { SKY_DISTANCE, type SkyLayer } from '../view/SkyLayer'

/** Transmittance below which a foreground layer hides what is behind it. Greater: shafts end at thin clouds (*Below a broken deck*). */
const MIN_TRANSMITTANCE = 0.01

/** 1/τ² of what is not seen. */
const UNSEEN_RARITY = 1e14

/** log₂ of a distance that is beyond all. */
const FAR_OCTAVES = 40

/** Transmittance from which on a foreground is not seen. */
const CLEAR = 0.99

/** Air of a pixel. */
interface Seen extends SeenAir {
  /** log₂ of the distance of a foreground [m], and the part of the light that passes it. */
  readonly octaves?: Float
  readonly passes?: Float
}

/** End of a view ray. */
interface RayEnd extends Pick<ShaftRay, 'cosView' | 'distance'> {
  /** Displacement in the mapped space of what gives the ray's direction [m], and the reciprocal of its length. */
  readonly offset: Vec3
  readonly inverse: Float
  /** Reciprocal of the distance; 0 for the sky [1/m]. */
  readonly nearness: Float
}

/** 1/τ² of rays that the planet's ground ends, over what it is without: near the horizon both are as long. Nearer to 1: light of the ground's air in the sky beside it. */
const GROUND_RARITY = 16

const _size = new Vector2()

/**
 * Light shafts up to the depth of a picture, for post effects: see {@link LostLightGrid}.
 *
 * With a foreground layer, light in front of it counts in full, and light behind it as far as it passes: lost light is then
 * taken from the picture of both, at once.
 */
export class ScreenShafts implements ScreenShadows {
  readonly foreground: ForegroundLayer | undefined
  readonly #shafts: CameraShafts
  readonly #rays: DepthRays
  readonly grid: LostLightGrid
  /** 1 if there is a medium, such as fog, in the light of the shafts. */
  readonly #hasMedia = number()
  /** `strengthNow`; 0 while the node of a foreground layer draws the shafts. */
  readonly #strength = number()
  /** 1 if what is behind the foreground has shafts already. */
  readonly #isForward = number()
  /** Output per lost light of which the grid keeps parts: half floats hold the moon's, too. */
  readonly #gain = number(1)

  /** @param isMesh - True for a mesh of air, whose rays end at the planet or nowhere. */
  constructor(
    shafts: CameraShafts,
    depthNode: Node,
    foreground?: ForegroundLayer,
    readonly isMesh = false
  ) {
    this.foreground = foreground
    this.grid = new LostLightGrid(foreground !== undefined)
    this.#shafts = shafts
    this.#rays = new DepthRays(depthNode, shafts.camera)
  }

  prepareShadows(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void {
    const shafts = this.#shafts
    // Anew, after a dispose.
    shafts.screens.add(this)
    shafts.prepare(renderer, view, frame)
    shafts.view.update(view)
    shafts.update(view)
  }

  prepare(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void {
    const shafts = this.#shafts
    shafts.screens.add(this)
    if (this.#isDrawnByForeground) return
    if (this.foreground === undefined) shafts.prepare(renderer, view, frame)
    const { width, height } = renderer.getRenderTarget() ?? renderer.getDrawingBufferSize(_size)
    this.grid.resize(width, height, spacingIn(shafts.spacing, width, height))
    if (!shafts.isActive) return
    // What is drawn here and now reads the view, and media in it.
    shafts.view.update(view)
    const { parameters, layers } = shafts.view.atmosphere
    const [air, above] = [0, THIN_HEIGHT].map(more =>
      Math.min(...extinction(parameters, densities(parameters, Math.max(view.height, 0) + more)))
    )
    const media = layers.filter(isShadowed)
    for (const layer of media) layer.update?.(view)
    const fog = media.reduce((sum, { extinction = 0 }) => sum + extinction, 0)
    const isFog = (layer: SkyLayer): boolean => 'shadowed' in layer && layer.extinction !== 0
    this.#hasMedia.value = Number(media.some(isFog))
    const { source, air: lookUp } = shafts.view
    const most = Math.max(...lookUp.uniforms.linearSRGB.map(({ value }) => value.y))
    this.#gain.value = Math.max(most, 1e-30) * Math.max(...source.irradiance.value.toArray(), 1e-30)
    this.grid.setAir(air, above, fog, parameters.bottomRadius)
    this.grid.render(renderer, shafts.version, (at, pixel) => this.#march(renderer, at, pixel))
  }

  update(view: AtmosphereView): void {
    this.#shafts.update(view)
    this.#strength.value = this.#isDrawnByForeground ? 0 : this.#shafts.strengthNow.value
    this.#isForward.value = Number(this.#shafts.isForward)
  }

  /** Draws none until the next {@link update}. */
  protected hide(): void {
    this.#strength.value = 0
  }

  lostAt(position: Vec3, isSky: Bool): Vec3 | undefined {
    if (this.#isDrawnByForeground) return undefined
    const lost = vec3(0).toVar()
    If(this.#strength.greaterThan(0), () => {
      lost.assign(this.#lostUpTo(this.#endAt(position, isSky)))
    })
    return lost
  }

  /** Place of a fragment in the picture: meshes have coordinates of their own. */
  get #place(): Vec2 {
    return this.isMesh ? screenUV : uv()
  }

  #lostUpTo(end: RayEnd, transmittance?: Float, shown?: Vec3): Vec3 {
    const at = this.#place
    const seen = this.#seenAt(at, end, transmittance)
    // Asked in a branch: few pixels need the air on their ray.
    const lit = (to: Float): Vec3 => this.#lightOn(this.#rayTo(end))(to)
    const lost = this.grid.read(at, seen, lit, shown && { light: shown, gain: this.#gain })
    return lost.mul(this.#gain.mul(this.#strength))
  }

  /** True if the node of a foreground layer draws the shafts, so that this one has no part in its shader. */
  get #isDrawnByForeground(): boolean {
    const { screens, isForward } = this.#shafts
    return this.foreground === undefined && screens.hasForeground && !(this.isMesh && isForward)
  }

  dim(color: Vec3, transmittance?: Float): Vec3 {
    const left = color.toVar()
    if (this.#isDrawnByForeground) return left
    If(this.#strength.greaterThan(0), () => {
      const lost = Fn(({ renderer }): Vec3 =>
        this.#lostUpTo(this.#endIn(renderer, this.#place), transmittance, left)
      )()
      // Clouds may also give light.
      left.subAssign(lost.min(left))
    })
    return left
  }

  /** Foreground before a distance [m], and air that is seen: behind a foreground shadows of materials are dimmed with them. */
  #seenAt(at: Vec2, end: RayEnd, transmittance?: Float): Seen {
    const { foreground, grid } = this
    const least = grid.leastRarity(end.cosView)
    const whole = this.#rarityOf(end, least)
    if (foreground === undefined) return { rarity: whole, least }
    const passes = transmittance ?? foreground.transmittanceAt(at)
    const isSeen = passes.lessThan(CLEAR).toConst()
    const octaves = float(FAR_OCTAVES).toVar()
    const rarity = whole.add(this.#isForward.mul(UNSEEN_RARITY)).toVar()
    If(isSeen, () => {
      octaves.assign(foreground.octavesAt(at))
      const nearness = octaves.negate().exp2().max(end.nearness)
      rarity.assign(rarityThrough(grid.rarityTo(nearness, least), rarity, passes))
    })
    return { rarity, least, octaves, passes, isSeen }
  }

  /** 1/τ² up to the end of a ray. Ground of the planet before which nothing is drawn is told from the sky beside it. */
  #rarityOf({ distance, nearness }: RayEnd, least: Float): Float {
    // `distanceOf` has no other ray end there.
    const isGround = distance.equal(SKY_DISTANCE) as Bool
    return this.grid.rarityTo(nearness, least).mul(isGround.select(GROUND_RARITY, 1))
  }

  /** Light that the ray of a pixel of the grid loses. */
  #march(renderer: Renderer, at: Vec2, pixel: Vec2): LostLight {
    const { view, shadowedAir, steps } = this.#shafts
    const end = this.#endIn(renderer, at)
    const ray = this.#rayTo(end)
    const { distance } = ray
    const { octaves, passes, rarity, least } = this.#seenAt(at, end)
    const { isOrthographicCamera } = this.#shafts.camera as OrthographicCamera
    const start = isOrthographicCamera
      ? view.toMapped(vec3(this.#rays.position(renderer, at, float(0.5)).xy, 0))
      : undefined
    let seen: ShaftRay = { ...ray, start }
    if (octaves && passes) {
      const nearest = octaves.exp2().min(distance).toConst() as Float
      const behind = passes.mul(this.#isForward.oneMinus()).toConst() as Float
      const before = passes.oneMinus().add(behind).toConst() as Float
      seen = {
        ...seen,
        distance: behind.greaterThan(MIN_TRANSMITTANCE).select(distance, nearest).toConst(),
        seenFrom: from => from.lessThan(nearest).select(before, behind)
      }
    }
    const lost = lostLight(view, shadowedAir, seen, steps, staggered(pixel))
    const whole = this.#rarityOf(end, least)
    return { lost: this.#color(lost), lit: this.#lightOn(ray), whole, rarity, least }
  }

  /** End of a view ray on what was drawn; else beyond the air, or behind the planet's ground. */
  #endIn(renderer: Renderer, at: Vec2): RayEnd {
    const { position, isSky } = this.isMesh
      ? { position: this.#rays.position(renderer, at, float(0.5)), isSky: bool(true) as Bool }
      : this.#rays.at(renderer, at)
    return this.#endAt(position, isSky)
  }

  #endAt(position: Vec3, isSky: Bool): RayEnd {
    const { view } = this.#shafts
    const offset = view.toMapped(position).toConst() as Vec3
    const square = offset.dot(offset).max(1e-6).toConst() as Float
    const inverse = square.inverseSqrt().toConst() as Float
    const cosView = offset.dot(view.up).mul(inverse).toConst() as Float
    const beyond = distanceOf({ hitsGround: cosView.lessThan(view.viewpoint.cosHorizon) })
    const distance = isSky.select(beyond, square.mul(inverse)).toConst() as Float
    const nearness = isSky.select(0, inverse).toConst() as Float
    return { offset, inverse, nearness, cosView, distance }
  }

  #rayTo({ offset, inverse, cosView, distance }: RayEnd): ShaftRay {
    const direction = offset.mul(inverse).toConst() as Vec3
    const cosViewLight = direction.dot(this.#shafts.view.lightDirection).toConst() as Float
    return { direction, cosView: cosView.clamp(-1, 1).toConst(), cosViewLight, distance }
  }

  /** Light for unit irradiance [1/sr] as the grid keeps it. */
  #color(light: Vec4): Vec3 {
    const { air, source } = this.#shafts.view
    return unclampedSRGB(air.uniforms, light.mul(source.irradiance)).div(this.#gain).toConst()
  }

  /** Light of the air on a ray without shadows up to a distance, or its end, as the grid keeps it. */
  #lightOn(ray: ShaftRay): (distance: Float) => Vec3 {
    const { view, shadowedAir } = this.#shafts
    const { air, volume, viewpoint } = view
    const { cosView, cosViewLight } = ray
    return to => {
      const distance = ray.distance.min(to).toConst()
      const at = [cosView, cosViewLight, rayLimits(viewpoint, cosView), distance] as const
      const { radiance, depth } = sampleVolume(air.uniforms, volume, viewpoint, ...at)
      const light = radiance.toVar()
      If(this.#hasMedia.greaterThan(0), () => {
        const media = shadowedAir.mediaOn({ ...ray, view, distance })
        for (const { transmittance, ahead, singleScattered } of media) {
          const left = ahead ? mix(transmittance, 1, ahead(depth)) : transmittance
          light.assign(light.mul(left).add(singleScattered ?? 0))
        }
      })
      return this.#color(light)
    }
  }

  /** Takes them out of the shafts of their camera, until they are drawn again. */
  dispose(): void {
    this.#shafts.screens.delete(this)
    this.free()
  }

  /** Frees its textures, which are made again where they are drawn. */
  free(): void {
    this.grid.dispose()
  }
}
