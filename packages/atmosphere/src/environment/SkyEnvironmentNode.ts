import type { Camera } from 'three'
import { vec3 } from 'three/tsl'
import { Node, NodeUpdateType } from 'three/webgpu'
import type { NodeBuilder, NodeFrame, Renderer } from 'three/webgpu'
import { checkBoolean, checkOptions, checkPositive, fail, setOptions } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { DrawnSky } from './DrawnSky'
import { mirrored, type EnvironmentOptions } from './ImageEnvironmentNode'
import { SkyCube } from './SkyCube'
import type { SkyOverlay } from './SkyOverlay'
import { checkAtmosphere, viewNodes, type ViewNodes } from '../view/ViewNodes'

/** Options of {@link SkyEnvironmentNode}. */
export interface SkyEnvironmentOptions extends EnvironmentOptions {
  /** Texels along the edge of a cube face, a power of two in [256, 2048]; by default 256. */
  size?: number
  /** Angle by which the sun or the axes of the world may turn before it is drawn again, > 0; by default 0.1 [°]. */
  angle?: number
  /** Climb of the camera before it is drawn again, as a part of its height (at least 500 m), > 0; by default 0.1 [–]. */
  climb?: number
  /** Picture in front of the sky: `cloudEnvironment` of `@welkin/clouds`; by default none. Shared, not owned. */
  overlay?: SkyOverlay | null
}

const SETTINGS = ['angle', 'climb'] as const

/**
 * Sky and ground as what materials mirror: a scene's environment, through three's prefiltered maps.
 *
 * ```ts
 * scene.environmentNode = skyEnvironment(atmosphere)
 * ```
 *
 * It has no sun: `SunDirectionalLight` is that, with its highlight; nor moon and stars. Layers of the
 * atmosphere that glow, fog and ground are in it. It is drawn once, and again, in place, when sun or
 * altitude have changed by more than a threshold, parameters of the air at all, or layers, theirs by the
 * count of {@link SkyLayer.version}: a face of the cube a frame, then a part of the filter a
 * frame, fifteen frames for the default size and some more for an overlay. Until the new map is complete, the old one is mirrored.
 * `luminanceScale` acts at once. What is painted on the textures of a `planetGround` is not followed: set
 * {@link needsRedraw}. It is seen from the camera's place: things far away from the camera mirror the camera's sky.
 *
 * `scene.environmentIntensity` and the materials' roughness act as they do with any environment.
 */
export class SkyEnvironmentNode extends Node<'vec3'> {
  static get type(): string {
    return 'SkyEnvironmentNode'
  }

  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  /** See {@link EnvironmentOptions}; null for what suits the scene's lights. */
  readonly diffuse: boolean | null
  /** See {@link SkyEnvironmentOptions}. */
  readonly overlay: SkyOverlay | null
  /** Draws all of it before the next frame, whatever has changed. */
  needsRedraw = true
  /** Number of times that it was drawn. */
  redraws = 0
  /** Texels along the edge of a cube face. */
  readonly size: number
  readonly #view: ViewNodes
  readonly #cube: SkyCube
  readonly #drawn: DrawnSky
  #overlayVersion = 0
  #frame = -1
  #camera: Camera | null = null
  #renderer: Renderer | null = null
  #angle = 0.1
  #climb = 0.1
  readonly #release = (): void => this.#free()

  /** @throws If the atmosphere is missing or an option out of range. */
  constructor(atmosphere: Atmosphere, options: SkyEnvironmentOptions = {}) {
    super('vec3')
    const where = 'SkyEnvironmentNode'
    checkAtmosphere(where, atmosphere)
    checkOptions(where, options, 'diffuse', 'size', 'overlay', ...SETTINGS)
    const { diffuse, size = 256, overlay = null, ...settings } = options
    if (!(size >= 256 && size <= 2048 && Number.isInteger(Math.log2(size)))) {
      fail(where, 'size must be a power of two in [256, 2048]', size)
    }
    if (diffuse !== undefined) checkBoolean(where, 'diffuse', diffuse)
    if (overlay !== null && typeof overlay?.over !== 'function') {
      fail(where, 'overlay must be a SkyOverlay, such as cloudEnvironment(), or null', overlay)
    }
    this.atmosphere = atmosphere
    this.diffuse = diffuse ?? null
    this.size = size
    this.set(settings)
    this.overlay = overlay
    this.updateBeforeType = NodeUpdateType.RENDER
    this.updateType = NodeUpdateType.RENDER
    this.#view = viewNodes(atmosphere)
    this.#drawn = new DrawnSky(atmosphere)
    this.#cube = new SkyCube(atmosphere, size, overlay)
    atmosphere.addEventListener('dispose', this.#release)
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or out of range; then nothing has changed.
   */
  set(settings: Pick<SkyEnvironmentOptions, (typeof SETTINGS)[number]>): this {
    return setOptions('SkyEnvironmentNode', this, settings, ...SETTINGS)
  }

  /** See {@link SkyEnvironmentOptions}, > 0 [°]. */
  get angle(): number {
    return this.#angle
  }

  set angle(value: number) {
    checkPositive('SkyEnvironmentNode', 'angle', value)
    this.#angle = value
  }

  /** See {@link SkyEnvironmentOptions}, > 0. */
  get climb(): number {
    return this.#climb
  }

  set climb(value: number) {
    checkPositive('SkyEnvironmentNode', 'climb', value)
    this.#climb = value
  }

  override updateBefore(frame: NodeFrame): undefined {
    // The frame is shared: renders that prepare the view leave their camera in it.
    const { renderer, camera, frameId } = frame
    this.#view.prepare(frame)
    if (renderer !== null && camera !== null) this.#redrawIfStale(renderer, camera, frameId)
  }

  // Drawing the sky from another camera set the layers' uniforms for that.
  override update(frame: NodeFrame): undefined {
    this.#cube.show()
    const view = this.#view.update(frame)
    if (view === undefined) return
    for (const layer of this.atmosphere.layers) layer.update?.(view)
  }

  #redrawIfStale(renderer: Renderer, camera: Camera, frameId: number): void {
    const view = this.atmosphere.viewOf(camera)
    if (view === undefined || view.viewpoint === null) return
    // The first camera of a frame leads: a mirror's may be below ground.
    const isLed = frameId === this.#frame && camera !== this.#camera
    if (isLed && this.redraws > 0) return
    this.#frame = frameId
    this.#camera = camera
    // What another renderer drew went with it.
    if (renderer !== this.#renderer) this.needsRedraw = true
    this.#renderer = renderer
    const cube = this.#cube
    const version = this.overlay?.version ?? 0
    const isSame = (): boolean =>
      version === this.#overlayVersion && this.#drawn.resembles(view, this.angle, this.climb)
    if (this.needsRedraw || (cube.isIdle && !isSame())) {
      this.#drawn.set(view)
      this.#overlayVersion = version
      cube.restart(renderer, camera.matrixWorld)
    }
    if (cube.isIdle) return
    if (!cube.draw(renderer, this.needsRedraw)) return
    this.redraws++
    this.needsRedraw = false
  }

  override setup(builder: NodeBuilder): Node {
    const { renderer, camera } = builder as unknown as { renderer: Renderer; camera: Camera }
    // The map must be there when a material is made, as three's own node has it.
    if (this.#cube.node === null && camera !== null) {
      this.#view.prepare({ renderer, camera } as NodeFrame)
      this.#redrawIfStale(renderer, camera, -1)
    }
    const { node } = this.#cube
    return node === null ? vec3(0) : mirrored(builder, node, this.diffuse)
  }

  #free(): void {
    this.#cube.dispose()
    this.needsRedraw = true
  }

  /** Frees GPU memory. */
  override dispose(): void {
    this.#free()
    this.atmosphere.removeEventListener('dispose', this.#release)
    super.dispose()
  }
}

/** An atmosphere's sky as what materials mirror: see {@link SkyEnvironmentNode}. */
export const skyEnvironment = (
  atmosphere: Atmosphere,
  options?: SkyEnvironmentOptions
): SkyEnvironmentNode => new SkyEnvironmentNode(atmosphere, options)
