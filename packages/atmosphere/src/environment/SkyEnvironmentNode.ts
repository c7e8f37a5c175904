import { Matrix3, Vector3 } from 'three'
import type { Camera, Texture } from 'three'
import { normalWorld, pmremTexture, vec3 } from 'three/tsl'
import { Node, NodeUpdateType } from 'three/webgpu'
import type { NodeBuilder, NodeFrame, Renderer } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { SkyLayer } from '../view/SkyLayer'
import { SkyCube } from './SkyCube'
import type { SkyOverlay } from './SkyOverlay'
import { viewNodes, type ViewNodes } from '../view/ViewNodes'

/** Options of {@link skyEnvironment}. */
export interface EnvironmentOptions {
  /**
   * Whether it lights matte surfaces too, besides being mirrored. By default it does, unless a
   * `SkyLightProbe` lights the scene: their light must not count twice.
   */
  diffuse?: boolean
}

/** Options of {@link SkyEnvironmentNode}. */
export interface SkyEnvironmentOptions extends EnvironmentOptions {
  /** Texels along the edge of a cube face, a power of two in [256, 2048]. */
  size?: number
  /** How far the sun may move, or the axes of the world turn, before it is drawn again, > 0 [°]. */
  angle?: number
  /** How far the camera may climb or sink, as a part of its height (at least 500 m), > 0. */
  climb?: number
  /** What is in front of the sky: `cloudEnvironment` of `@welkin/clouds`. Shared, not owned. */
  overlay?: SkyOverlay | null
}

const RADIANS = Math.PI / 180
/** Cameras lower than this see the same sky [m]. */
const LOW = 500
/** Change of the sun's irradiance, in an eclipse say, that shows. */
const DIMMING = 0.02
/** Factor of the luminance scale up to which half floats resolve a tenth of a grey level. */
const RESCALING = 1000

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
  /** See {@link SkyEnvironmentOptions} [°]. */
  angle: number
  /** See {@link SkyEnvironmentOptions}. */
  climb: number
  /** See {@link SkyEnvironmentOptions}. */
  readonly overlay: SkyOverlay | null
  /** Draws all of it before the next frame, whatever has changed. */
  needsRedraw = true
  /** How often it was drawn. */
  redraws = 0
  readonly #view: ViewNodes
  readonly #cube: SkyCube
  readonly #drawn = new DrawnSky()
  #overlayVersion = 0
  #frame = -1
  #camera: Camera | null = null
  readonly #release = (): void => this.#free()

  /** @throws If the atmosphere is missing or an option out of range. */
  constructor(
    atmosphere: Atmosphere,
    { diffuse, size = 256, angle = 0.1, climb = 0.1, overlay = null }: SkyEnvironmentOptions = {}
  ) {
    super('vec3')
    if (!atmosphere?.isAtmosphere) {
      throw new Error(
        `SkyEnvironmentNode: atmosphere must be an Atmosphere, got ${typeof atmosphere}`
      )
    }
    if (!(size >= 256 && size <= 2048 && Number.isInteger(Math.log2(size)))) {
      throw new Error(`SkyEnvironmentNode: size must be a power of two in [256, 2048], got ${size}`)
    }
    for (const [name, value] of Object.entries({ angle, climb })) {
      if (!(value > 0)) {
        throw new Error(`SkyEnvironmentNode: ${name} must be positive, got ${value}`)
      }
    }
    this.atmosphere = atmosphere
    this.diffuse = diffuse ?? null
    this.angle = angle
    this.climb = climb
    this.overlay = overlay
    this.updateBeforeType = NodeUpdateType.RENDER
    this.updateType = NodeUpdateType.RENDER
    this.#view = viewNodes(atmosphere)
    this.#cube = new SkyCube(atmosphere, size, overlay)
    atmosphere.addEventListener('dispose', this.#release)
  }

  override updateBefore(frame: NodeFrame): undefined {
    // The frame is shared: renders that prepare the view leave their camera in it.
    const { renderer, camera, frameId } = frame
    this.#view.prepare(frame)
    if (renderer !== null && camera !== null) this.#follow(renderer, camera, frameId)
  }

  // Drawing the sky from another camera set the layers' uniforms for that.
  override update(frame: NodeFrame): undefined {
    this.#cube.show()
    const view = this.#view.update(frame)
    if (view === undefined) return
    for (const layer of this.atmosphere.layers) layer.update?.(view)
  }

  #follow(renderer: Renderer, camera: Camera, frameId: number): void {
    const view = this.atmosphere.viewOf(camera)
    if (view === undefined || view.eye === null) return
    // The first camera of a frame leads: a mirror's may be below ground.
    const isLed = frameId === this.#frame && camera !== this.#camera
    if (isLed && this.redraws > 0) return
    this.#frame = frameId
    this.#camera = camera
    const cube = this.#cube
    const version = this.overlay?.version ?? 0
    const isSame = (): boolean =>
      version === this.#overlayVersion && this.#drawn.resembles(view, this.angle, this.climb)
    if (this.needsRedraw || (cube.isIdle && !isSame())) {
      this.#drawn.set(view)
      this.#overlayVersion = version
      cube.aim(renderer, camera.matrixWorld)
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
      this.#follow(renderer, camera, -1)
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

/** What the sky was when it was last drawn, by all that it depends on. */
class DrawnSky {
  #height = NaN
  #tablesVersion = -1
  #scale = NaN
  #layers: readonly SkyLayer[] = []
  #versions: readonly (number | undefined)[] = []
  readonly #sun = new Vector3()
  readonly #up = new Vector3()
  readonly #axes = new Matrix3()
  readonly #irradiance = [0, 0, 0, 0]
  readonly #toMapped = new Matrix3()

  /** World to mapped axes, of which columns of unit length count. */
  #axesOf({ camera, viewToMapped }: AtmosphereView): Matrix3 {
    const rotation = this.#toMapped.setFromMatrix4(camera.matrixWorld).transpose()
    return rotation.premultiply(viewToMapped)
  }

  set(view: AtmosphereView): void {
    this.#height = view.height
    this.#tablesVersion = view.atmosphere.tables.version
    this.#scale = view.atmosphere.luminanceScale
    this.#layers = [...view.atmosphere.layers]
    this.#versions = this.#layers.map(({ version }) => version)
    this.#sun.copy(view.sunDirection)
    this.#up.copy(view.up)
    this.#axes.copy(this.#axesOf(view))
    view.irradiance.forEach((value, i) => (this.#irradiance[i] = value))
  }

  resembles(view: AtmosphereView, angle: number, climb: number): boolean {
    const reach = 2 * Math.sin((Math.min(angle, 180) * RADIANS) / 2)
    const axes = this.#axesOf(view).elements
    const scale = Math.hypot(axes[0], axes[1], axes[2]) || 1
    const { layers, luminanceScale, tables } = view.atmosphere
    return (
      tables.version === this.#tablesVersion &&
      layers.length === this.#layers.length &&
      layers.every(
        (layer, i) => layer === this.#layers[i] && layer.version === this.#versions[i]
      ) &&
      Math.abs(Math.log(luminanceScale / this.#scale)) <= Math.log(RESCALING) &&
      this.#sun.distanceTo(view.sunDirection) <= reach &&
      this.#up.distanceTo(view.up) <= reach &&
      this.#axes.elements.every((value, i) => Math.abs(value - axes[i]) <= reach * scale) &&
      Math.abs(view.height - this.#height) <= climb * Math.max(Math.abs(this.#height), LOW) &&
      view.irradiance.every((value, i) => Math.abs(value - this.#irradiance[i]) <= DIMMING * value)
    )
  }
}

/** A picture of a sky in place of the sky: see {@link skyEnvironment}. */
export class ImageEnvironmentNode extends Node<'vec3'> {
  static get type(): string {
    return 'ImageEnvironmentNode'
  }

  /** Equirectangular, a cube, or filtered already. Shared, not owned. */
  readonly image: Texture
  /** See {@link EnvironmentOptions}; null for what suits the scene's lights. */
  readonly diffuse: boolean | null

  constructor(image: Texture, { diffuse }: EnvironmentOptions = {}) {
    super('vec3')
    this.image = image
    this.diffuse = diffuse ?? null
  }

  override setup(builder: NodeBuilder): Node {
    let map = maps.get(this.image)
    if (map === undefined) maps.set(this.image, (map = pmremTexture(this.image)))
    return mirrored(builder, map, this.diffuse)
  }
}

const maps = new WeakMap<Texture, Node>()

/** What a material gets from a map: by roughness what it mirrors, or light from all around. */
function mirrored(builder: NodeBuilder, map: Node, diffuse: boolean | null): Node {
  const { context, lightsNode } = builder as unknown as {
    context: { getUV?: (node: Node, builder: NodeBuilder) => unknown }
    lightsNode: { getLights?: () => object[] } | null
  }
  // Light on matte surfaces is what three asks about the normal, not the mirrored ray.
  if (context.getUV?.(map, builder) !== normalWorld) return map
  const lights = lightsNode?.getLights?.() ?? []
  const hasProbe = lights.some(light => 'isLightProbe' in light && 'atmosphere' in light)
  return (diffuse ?? !hasProbe) ? map : vec3(0)
}

/**
 * What materials of a scene mirror: an atmosphere's sky, or a picture that stands in for it, loaded by
 * three's `HDRLoader` say. See {@link SkyEnvironmentNode}.
 *
 * ```ts
 * scene.environmentNode = skyEnvironment(atmosphere)
 * scene.environmentNode = skyEnvironment(await new HDRLoader().loadAsync('sky.hdr'))
 * ```
 *
 * @param source - A texture may be equirectangular or a cube.
 * @throws If it is neither an atmosphere nor a texture, or an option is out of range.
 */
export function skyEnvironment(
  source: Atmosphere,
  options?: SkyEnvironmentOptions
): SkyEnvironmentNode
export function skyEnvironment(source: Texture, options?: EnvironmentOptions): ImageEnvironmentNode
export function skyEnvironment(
  source: Atmosphere | Texture,
  options?: SkyEnvironmentOptions
): SkyEnvironmentNode | ImageEnvironmentNode {
  if ('isTexture' in Object(source)) return new ImageEnvironmentNode(source as Texture, options)
  if ('isAtmosphere' in Object(source)) {
    return new SkyEnvironmentNode(source as Atmosphere, options)
  }
  throw new Error(`skyEnvironment: source must be an Atmosphere or a Texture, got ${typeof source}`)
}
