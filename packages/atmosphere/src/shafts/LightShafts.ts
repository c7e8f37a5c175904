import { Matrix3, Matrix4 } from 'three'
import type { Camera } from 'three'
import { vec4 } from 'three/tsl'
import type { Node, NodeFrame, Renderer } from 'three/webgpu'
import { checkBoolean, checkChoice, checkNonNegative, setOptions } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { checkCamera, checkShadowLight } from '../check'
import type { Float } from '../tsl-types'
import { matrix4, number } from '../uniforms'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { AirPicture, ForegroundLayer, ScreenShadows } from '../view/AirShadows'
import type { LightSource } from '../view/LightSource'
import type { SkyLayer } from '../view/SkyLayer'
import { checkAtmosphere, viewNodes, type ViewNodes } from '../view/ViewNodes'
import type { AirOccluder, AirViewRay, ShadowedShafts } from './AirOccluder'
import { CastShadows } from './CastShadows'
import { ScreenShafts } from './ScreenShafts'
import { checkPicture, ShaftScreens } from './ShaftScreens'
import { claimShadow, drawShadow, releaseShadow, shadowMapsOf } from './shadowMaps'
import type { ParallelLight } from './shadowMaps'
import { qualities, qualityNames, type LightShaftsQuality } from './quality'
import { SunPolarMap } from './SunPolarMap'
import { mediaIn } from './tsl/lostInMedia'
import { litAt, type ShadowedAir } from './tsl/shadowsAlong'

/** Options of {@link LightShafts}. */
export interface LightShaftsOptions {
  /** See {@link LightShafts.strength}; by default 1. */
  strength?: number
  /** See {@link LightShafts.quality}; by default `'medium'`. */
  quality?: LightShaftsQuality
  /** See {@link LightShafts.enabled}; by default true. */
  enabled?: boolean
}

const SETTINGS = ['strength', 'quality', 'enabled'] as const

const _linear = new Matrix3()
const _axes = new Matrix4()

/**
 * Light shafts: what shadows take from the light that the air scatters to a camera.
 *
 * ```ts
 * const shafts = lightShafts(atmosphere, camera, sun)
 * const air = aerialPerspective(color, depth, camera, atmosphere, { shafts })
 * ```
 *
 * These are for post effects, and for clouds. Materials that draw the air themselves, and meshes of air, have shafts by
 * {@link ForwardShafts}, which are these and more.
 *
 * Shadows are those that three has drawn of the light in the same frame: of one map, of `CSMShadowNode`, or
 * of `SunLight`'s cascades; standard and reversed depth. Beyond them air is lit but for what was added. Air and fogs in
 * shadow lose the light that they scatter once; light scattered more often, which comes from all sides, stays. A scene
 * without shadows is the same, bit for bit, as without shafts, and one whose light casts none costs nothing.
 *
 * Clouds, hills and the like are added: `shafts.add(cloudAirShadow(cloudsNode))`, or a `heightFieldShadow`. They need no
 * shadow map of the light.
 *
 * Needs a texture of 0.5 MB, and 5 bytes a pixel of the picture (1 at `'low'` and `'medium'` quality).
 *
 * @see Chen et al. 2011, "Real-time volumetric shadows using 1D min-max mipmaps", fig. 1 (a map in polar
 *   coordinates about the camera); Yusov 2014, "High performance outdoor light scattering using epipolar sampling",
 *   GPU Pro 5, part II, §2.3
 */
export class LightShafts implements ShadowedShafts {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  /** Camera whose picture has the shafts. */
  readonly camera: Camera
  /** Light whose shadows fall into the air; shared, not owned. */
  readonly light: ParallelLight
  /** Source of the light. */
  readonly source: LightSource
  /** The camera's view of the air in this light, for post effects. */
  readonly view: ViewNodes
  /** Samples on a view ray. */
  readonly steps = { groups: number(), samples: number(), beyond: number(), inFog: number() }
  protected readonly map = new SunPolarMap()
  protected readonly shadows = new CastShadows()
  readonly shadowedAir: ShadowedAir
  readonly #toWorld = matrix4()
  #version = 0
  /** Part of the light that air in shadow loses; 0 where shafts are off. */
  readonly strengthNow = number()
  readonly screens = new ShaftScreens()
  #setStrength = 1
  /** Render whose shadows the map has. */
  #render = ''
  #quality: LightShaftsQuality = 'medium'
  #enabled = true
  #isActive = false

  /**
   * @param camera - Camera whose picture has the shafts.
   * @param light - Light whose shadows fall into the air: a `SunDirectionalLight`, a `MoonDirectionalLight`, or a
   *   directional light of one's own, three's `SunLight` too, that shines from the atmosphere's sun. It must cast
   *   shadows for there to be shafts.
   * @throws If an argument is missing or of the wrong kind, or an option is unknown or out of range.
   */
  constructor(
    atmosphere: Atmosphere,
    camera: Camera,
    light: ParallelLight,
    options: LightShaftsOptions = {}
  ) {
    checkAtmosphere('LightShafts', atmosphere)
    checkCamera('LightShafts', camera)
    checkShadowLight('LightShafts', light, atmosphere)
    this.atmosphere = atmosphere
    this.camera = camera
    this.light = light
    this.source = light.source ?? atmosphere.sun
    this.view = viewNodes(atmosphere, camera, this.source)
    this.shadowedAir = this.shadowedIn(() => this.media)
    this.set(options)
    claimShadow(light, this)
  }

  /** Shadows in the air, and in some media in it. */
  protected shadowedIn(media: () => readonly SkyLayer[]): ShadowedAir {
    const { shadows, source, atmosphere } = this
    const { map, frame, maximumRho, intensity } = this.map
    return {
      map,
      frame,
      maximumRho,
      intensity,
      get shadows() {
        return shadows.all
      },
      ...mediaIn(media, () => source === atmosphere.sun),
      toWorld: offset => this.#toWorld.mul(vec4(offset, 1)).xyz
    }
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or refused; then nothing has changed.
   */
  set(settings: LightShaftsOptions): this {
    return setOptions('LightShafts', this, settings, ...SETTINGS)
  }

  /**
   * Has something cast its shadow into the air, besides the shadow maps of the light: clouds, or an
   * {@link AirOccluder} of one's own. Shaders are compiled anew. Clouds of the shafts' camera have these shafts in
   * the air in front of them.
   *
   * @returns These shafts.
   * @throws If something is no occluder, is there already, or is of another atmosphere; then nothing is added.
   */
  add(...occluders: AirOccluder[]): this {
    this.shadows.add(this, occluders)
    return this.compileAnew()
  }

  /** Takes out what was added; what was not is passed over. @returns These shafts. */
  remove(...occluders: AirOccluder[]): this {
    this.shadows.remove(occluders)
    return this.compileAnew()
  }

  protected compileAnew(): this {
    this.#version++
    return this
  }

  /** Factor on the light that air in shadow loses, finite, ≥ 0: 1 is physical; no air loses more than it has [–]. */
  get strength(): number {
    return this.#setStrength
  }

  set strength(value: number) {
    checkNonNegative('LightShafts', 'strength', value)
    this.#setStrength = value
  }

  /** Fineness of the march. A change compiles nothing. */
  get quality(): LightShaftsQuality {
    return this.#quality
  }

  set quality(value: LightShaftsQuality) {
    checkChoice('LightShafts', 'quality', value, qualityNames)
    this.#quality = value
  }

  /** False for air without shadows, at no cost. Nothing is compiled when it changes. */
  get enabled(): boolean {
    return this.#enabled
  }

  set enabled(value: boolean) {
    checkBoolean('LightShafts', 'enabled', value)
    this.#enabled = value
  }

  /** Grows whenever something is added or removed, here or in the sky. */
  get version(): number {
    return this.#version + this.atmosphere.layersVersion
  }

  /** True if there are shadows to be drawn, as of the last {@link prepare} for the camera. */
  get isActive(): boolean {
    return this.#isActive
  }

  litAt(ray: Omit<AirViewRay, 'view'>, distance: Float): Float {
    return litAt(this.view, this.shadowedAir, ray, distance, this.strengthNow)
  }

  /** Pixels of a large picture from one that is marched to the next. */
  get spacing(): number {
    return qualities[this.#quality].spacing
  }

  upTo(depthNode: Node, foreground?: ForegroundLayer, picture?: AirPicture): ScreenShadows {
    if (picture) checkPicture(picture, this)
    const screen = new ScreenShafts(this, depthNode, foreground)
    this.screens.add(screen)
    return screen
  }

  get isForward(): boolean {
    return false
  }

  /** @returns True if the shadows are drawn anew, not as those of the render before. */
  prepare(renderer: Renderer, { camera }: AtmosphereView, frame?: NodeFrame): boolean {
    if (camera !== this.camera) return false
    // Anew, after a dispose.
    claimShadow(this.light, this)
    const { atmosphere, source, steps } = this
    const view = atmosphere.viewOf(camera, source)
    const isLit = this.#enabled && this.#setStrength > 0 && view?.isLit && source.lightsAir
    const quality = qualities[this.#quality]
    if (isLit && frame && drawShadow(this.light, frame, camera)) {
      // Nodes of one render share the map.
      const render = `${frame.frameId} ${frame.renderId}`
      if (render === this.#render && this.isActive) return false
      this.#render = render
    }
    const maps = isLit ? shadowMapsOf(this.light) : []
    this.map.update(renderer, view!, atmosphere.space, maps, quality)
    this.#isActive = maps.length > 0
    if (isLit) this.#updateShadows(view, renderer)
    for (const [name, count] of Object.entries(steps))
      count.value = quality[name as keyof typeof steps]
    return true
  }

  #updateShadows(view: AtmosphereView, renderer: Renderer): void {
    this.atmosphere.space.displacement(_axes.identity(), _linear)
    this.#toWorld.value.setFromMatrix3(_linear.invert()).copyPosition(view.camera.matrixWorld)
    if (this.shadows.update(view, renderer)) this.#isActive = true
  }

  update({ camera }: AtmosphereView): void {
    this.strengthNow.value = this.isActive && camera === this.camera ? this.#setStrength : 0
  }

  /** Layers with shafts in their media. */
  protected get media(): readonly SkyLayer[] {
    return this.atmosphere.layers
  }

  /** Frees its textures, and the slot of the light's shadow. It can be used again. What was added stays, and lends it no maps until then. */
  dispose(): void {
    this.#isActive = false
    releaseShadow(this.light, this)
    this.map.dispose()
    this.shadows.free()
    for (const screen of this.screens) screen.free()
  }
}

/** Light shafts: see {@link LightShafts}. */
export const lightShafts = (
  atmosphere: Atmosphere,
  camera: Camera,
  light: ParallelLight,
  options?: LightShaftsOptions
): LightShafts => new LightShafts(atmosphere, camera, light, options)
