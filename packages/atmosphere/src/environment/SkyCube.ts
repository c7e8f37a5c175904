import { HalfFloatType, LinearSRGBColorSpace, Matrix3, PerspectiveCamera, Vector3 } from 'three'
import { Fn, positionWorldDirection, vec4 } from 'three/tsl'
import { CubeRenderTarget, RendererUtils } from 'three/webgpu'
import type { Node, Renderer } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import type { AtmosphereView } from '../view/AtmosphereView'
import { CubeFaces } from './CubeFaces'
import { PrefilteredCube } from './PrefilteredCube'
import type { SkyLayer } from '../view/SkyLayer'
import type { SkyOverlay } from './SkyOverlay'
import { skyColor } from '../sky/tsl/sky'
import type { Vec3 } from '../tsl-types'
import { viewNodes, type ViewNodes } from '../view/ViewNodes'
import { number, vector3 } from '../uniforms'

const FACES = 6

/**
 * Texels below the horizon over which the sky goes on, so that three's filter, which blurs even what
 * polished surfaces mirror, does not draw the ground into the sky that still water has at its horizon.
 */
const MARGIN = 12

const _position = new Vector3()
const _rotation = new Matrix3()

/**
 * Sky and ground about a place as three's prefiltered environment map, in the world's axes. Drawn face
 * by face and then filtered part by part, always into the same cubes.
 */
export class SkyCube {
  /** Stands where the sky is seen from, with the world's axes. */
  readonly camera = new PerspectiveCamera()
  readonly #atmosphere: Atmosphere
  readonly #size: number
  readonly #view: ViewNodes
  readonly #faces: CubeRenderTarget
  /** Zenith in world space. */
  readonly #up = vector3()
  readonly #drawer = new CubeFaces('Welkin.SkyEnvironment')
  readonly #filtered: PrefilteredCube
  #node: Node | null = null
  /** Luminance scale that all faces of a cube have; that of the map that was completed last. */
  #scale = 1
  #completedScale = 1
  /** Factors from the luminance scale of now to that of the cube, and from that of the map to now's. */
  readonly #toCube = number(1)
  readonly #fromMap = number(1)
  /** Layers that the shader has. */
  #layers: readonly SkyLayer[] | null = null
  readonly #overlay: SkyOverlay | null
  /** Faces drawn, negative while there are steps of the overlay to go; null while it rests. */
  #drawn: number | null = null

  /** @param size - Texels along the edge of a face, a power of two. */
  constructor(atmosphere: Atmosphere, size: number, overlay: SkyOverlay | null = null) {
    this.#overlay = overlay
    this.#atmosphere = atmosphere
    this.#view = viewNodes(atmosphere, this.camera)
    this.#faces = new CubeRenderTarget(size, {
      type: HalfFloatType,
      colorSpace: LinearSRGBColorSpace,
      depthBuffer: false,
      generateMipmaps: false
    })
    this.#faces.texture.name = 'SkyEnvironment'
    this.#filtered = new PrefilteredCube(this.#faces.texture)
    this.#size = size
  }

  /** The sky in the direction of a fragment, with the layers that there are. */
  #sky(): Node<'vec4'> {
    return Fn(() => {
      const direction = positionWorldDirection.toConst() as Vec3
      const height = direction.dot(this.#up).sub(this.#view.viewpoint.cosHorizon).toConst()
      const isNear = height.lessThan(0).and(height.greaterThan(-MARGIN / this.#size))
      // With the world's axes a direction in view space is one in world space.
      const raised = direction.add(this.#up.mul(isNear.select(height.negate().add(1e-4), 0)))
      const mapped = this.#view.toMapped(raised).normalize().toConst() as Vec3
      const sky = skyColor(this.#view, mapped, null)
      const light = this.#overlay?.over(this.#view, mapped, sky) ?? sky
      return vec4(light.mul(this.#toCube), 1)
    })()
  }

  /** Map that materials mirror, once there is one. */
  get node(): Node | null {
    const { node } = this.#filtered
    if (node !== null) this.#node ??= (node as Vec3).mul(this.#fromMap)
    return this.#node
  }

  /** True if no drawing is half done. */
  get isIdle(): boolean {
    return this.#drawn === null
  }

  /** Starts anew from a camera's position; what is drawn from now on shows the sky as it is now. */
  restart(renderer: Renderer, from: PerspectiveCamera['matrixWorld']): void {
    this.camera.matrixWorld.setPosition(_position.setFromMatrixPosition(from))
    const { up, viewToMapped } = this.#atmosphere.update(renderer, this.camera)
    this.#up.value.copy(up).applyMatrix3(_rotation.copy(viewToMapped).transpose()).normalize()
    this.#scale = this.#atmosphere.luminanceScale
    const { layers } = this.#atmosphere
    const isSame = (layer: SkyLayer, i: number): boolean => layer === this.#layers?.[i]
    if (layers.length !== this.#layers?.length || !layers.every(isSame)) {
      this.#layers = [...layers]
      this.#drawer.shader = this.#sky()
    }
    this.#drawn = -(this.#overlay?.steps ?? 0)
    this.#filtered.restart()
  }

  /**
   * Draws the next step of the overlay or the next face, or filters the next part, or does all that is left.
   *
   * @returns True once it is complete.
   */
  draw(renderer: Renderer, isWhole: boolean): boolean {
    const view = this.#atmosphere.viewOf(this.camera)
    if (this.#drawn === null || view === undefined || view.viewpoint === null) return false
    const state = RendererUtils.resetRendererState(renderer, {} as never)
    const isPresenting = renderer.xr.enabled
    renderer.xr.enabled = false
    renderer.setMRT(null)
    let isComplete = false
    if (this.#drawn < FACES) this.#prepare(renderer, view)
    if (isWhole) {
      while (this.#drawn < FACES) this.#drawPart(renderer, view, this.#drawn++)
      this.#filtered.filterAll(renderer)
      isComplete = true
    } else if (this.#drawn < FACES) this.#drawPart(renderer, view, this.#drawn++)
    else isComplete = this.#filtered.filterNext(renderer)
    if (isComplete) {
      this.#drawn = null
      this.#completedScale = this.#scale
    }
    renderer.xr.enabled = isPresenting
    RendererUtils.restoreRendererState(renderer, state)
    return isComplete
  }

  /** Shows materials the map that was completed last, at the luminance scale of now. */
  show(): void {
    this.#fromMap.value = this.#atmosphere.luminanceScale / this.#completedScale
  }

  #prepare(renderer: Renderer, view: AtmosphereView): void {
    const { layers, luminanceScale, tables } = this.#atmosphere
    // Another camera may have taken the sky volume since the last face.
    view.volume = tables.volumes.volumeFor(renderer, view.viewpoint!, tables.version)
    for (const layer of layers) layer.prepare?.(renderer, view)
    this.#view.update({ camera: this.camera })
    for (const layer of layers) layer.update?.(view)
    this.#toCube.value = this.#scale / luminanceScale
  }

  #drawPart(renderer: Renderer, view: AtmosphereView, face: number): void {
    if (face < 0) {
      this.#overlay?.draw(renderer, view, face + this.#overlay.steps)
      return
    }
    this.#drawer.draw(renderer, this.#faces, face)
  }

  /** Frees GPU memory; it can be drawn again. */
  dispose(): void {
    this.#faces.dispose()
    this.#filtered.dispose()
    this.#drawn = null
    this.#drawer.dispose()
  }
}
