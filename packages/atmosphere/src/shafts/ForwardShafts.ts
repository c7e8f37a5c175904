import type { Camera, OrthographicCamera } from 'three'
import { screenCoordinate } from 'three/tsl'
import type { NodeFrame, Renderer } from 'three/webgpu'
import { fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import type { MediumSegment } from '../skyVolume/tsl/skyVolume'
import type { Float } from '../tsl-types'
import type { MeshShadows } from '../view/AirShadows'
import type { AtmosphereView, ViewedAtmosphere } from '../view/AtmosphereView'
import type { LayerRay, SkyLayer } from '../view/SkyLayer'
import { screenRay } from '../view/tsl/screenRay'
import { viewNodes } from '../view/ViewNodes'
import { LightShafts, type LightShaftsOptions } from './LightShafts'
import { MeshShafts } from './MeshShafts'
import type { LightShaftsQuality } from './quality'
import type { ParallelLight } from './shadowMaps'
import { ShaftVolume } from './ShaftVolume'
import { isShadowed } from './tsl/lostInMedia'
import { lostLight, staggered } from './tsl/lostLight'
import { distanceOf, withoutLost } from './tsl/without'

/**
 * Light shafts for materials that draw the air themselves, with `skyBackground` and `aerialPerspectiveFog`, and for the air of an
 * `AtmosphereShell`: a {@link LightShafts} that is a layer of the sky besides, for one's own post effects, too.
 *
 * ```ts
 * const shafts = forwardShafts(atmosphere, camera, sun)
 * atmosphere.add(shafts)
 * ```
 *
 * Fogs that were added before have shafts, later ones none. Each fragment reads a volume of 144 × 81 rays in 24 slices,
 * which is drawn once a frame and takes 6 MB, with clouds 8. Compile a scene before its first frame, which else has none in its sky:
 * `await renderer.compileAsync(scene, camera)`.
 */
export class ForwardShafts extends LightShafts {
  readonly #volume = new ShaftVolume(this.camera)
  readonly #shadowedSky = this.shadowedIn(() => this.media.filter(({ leavesSky }) => !leavesSky))

  /** Fineness of the march. A change compiles nothing, but materials to and from `'reference'`, at which each fragment marches. */
  override get quality(): LightShaftsQuality {
    return super.quality
  }

  override set quality(value: LightShaftsQuality) {
    const wasMarched = this.isMarched
    super.quality = value
    if (this.isMarched !== wasMarched && this.isLayer) this.compileAnew()
  }

  protected override compileAnew(): this {
    super.compileAnew()
    // Layers that come again have materials compiled anew: with those after it, each stays where it was.
    const { atmosphere } = this
    const after = this.isLayer ? atmosphere.layers.slice(atmosphere.layers.indexOf(this)) : []
    if (this.isLayer) atmosphere.remove(...after).add(...after)
    return this
  }

  override get isForward(): boolean {
    return !this.screens.hasPostEffect && this.isLayer
  }

  private get isLayer(): boolean {
    return this.atmosphere.layers.includes(this)
  }

  /** True if each fragment marches: rays of orthographic cameras do not meet in the camera. */
  private get isMarched(): boolean {
    return this.quality === 'reference' || this.isOrthographic
  }

  private get isOrthographic(): boolean {
    return (this.camera as Partial<OrthographicCamera>).isOrthographicCamera === true
  }

  /** Layers before this one: not what comes later, which dims what is left. */
  protected override get media(): readonly SkyLayer[] {
    const { layers } = this.atmosphere
    return this.isLayer ? layers.slice(0, layers.indexOf(this)) : layers
  }

  onMesh(): MeshShadows {
    const screen = new MeshShafts(this)
    this.screens.add(screen)
    return screen
  }

  /** Called before it is added. @throws If it is another atmosphere's. */
  attach(atmosphere: ViewedAtmosphere): void {
    if (atmosphere !== this.atmosphere)
      fail('ForwardShafts', 'atmosphere must be that of its layers', atmosphere)
    const { sums } = this.#volume
    sums.room = undefined
    if (this.isMarched) return
    // In the texture of the first that has any.
    for (const shadow of this.shadows.all) sums.room ??= shadow.makeRoom?.()
  }

  override prepare(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): boolean {
    const isNew = super.prepare(renderer, view, frame)
    if (isNew) this.#drawVolume(renderer)
    return isNew
  }

  /** Draws what materials read. */
  #drawVolume(renderer: Renderer): void {
    const view = this.atmosphere.viewOf(this.camera, this.source)
    // While they are off, too: what has drawn with the textures in this frame must find them at its end.
    const isUsed = this.isLayer && !this.isMarched
    this.#volume.resize(renderer, isUsed)
    if (!isUsed || !this.isActive || view === undefined) return
    this.view.update(view)
    for (const layer of this.media) if (isShadowed(layer)) layer.update?.(view)
    const mapped = this.shadows.all.length > 0 ? Infinity : this.map.maximumRho.value
    this.#volume.draw(renderer, this, this.#shadowedSky, mapped)
  }

  medium({ view, direction, cosView, ...to }: LayerRay, air: MediumSegment): MediumSegment {
    const lit = viewNodes(this.atmosphere, view.camera, this.source)
    const taken = lit.source.irradiance.mul(this.strengthNow)
    return withoutLost(air, this.strengthNow, () => {
      if (!this.isMarched) {
        return taken.mul(to.distance ? this.#volume.lostTo(to.distance) : this.#volume.lostToSky())
      }
      const cosViewLight = direction.dot(lit.lightDirection).toConst() as Float
      const start = this.isOrthographic ? lit.toMapped(screenRay().origin) : undefined
      const ray = { direction, cosView, cosViewLight, distance: distanceOf(to), start }
      const pixel = screenCoordinate.xy.floor()
      return taken.mul(lostLight(lit, this.shadowedAir, ray, this.steps, staggered(pixel)))
    })
  }

  override dispose(): void {
    super.dispose()
    this.#volume.dispose()
  }
}

/** Light shafts for materials: see {@link ForwardShafts}. */
export const forwardShafts = (
  atmosphere: Atmosphere,
  camera: Camera,
  light: ParallelLight,
  options?: LightShaftsOptions
): ForwardShafts => new ForwardShafts(atmosphere, camera, light, options)
