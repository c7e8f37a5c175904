import {
  BackSide,
  BoxGeometry,
  CubeCamera,
  HalfFloatType,
  LinearSRGBColorSpace,
  Matrix3,
  Mesh,
  NoBlending,
  PerspectiveCamera,
  Vector3
} from 'three'
import type { Texture } from 'three'
import { Fn, positionWorldDirection, renderGroup, uniform, vec4 } from 'three/tsl'
import { CubeRenderTarget, NodeMaterial, PMREMGenerator, RendererUtils } from 'three/webgpu'
import type { Renderer } from 'three/webgpu'
import type { Atmosphere } from './Atmosphere'
import type { AtmosphereView } from './AtmosphereView'
import { skyColor } from './tsl/sky'
import type { Vec3 } from './tsl-types'
import { viewNodes, type ViewNodes } from './ViewNodes'

/** Faces of the cube, and the filter. */
export const SKY_CUBE_STEPS = 7

/**
 * Texels below the horizon over which the sky goes on, so that three's filter, which blurs even what
 * polished surfaces mirror, does not draw the ground into the sky that still water has at its horizon.
 */
const MARGIN = 12

const _position = new Vector3()
const _rotation = new Matrix3()

/**
 * Sky and ground about a place as three's prefiltered environment map, in the world's axes. Drawn in
 * {@link SKY_CUBE_STEPS} steps, always into the same two cubes.
 */
export class SkyCube {
  /** Stands where the sky is seen from, with the world's axes. */
  readonly camera = new PerspectiveCamera()
  readonly #atmosphere: Atmosphere
  readonly #view: ViewNodes
  readonly #faces: CubeRenderTarget
  readonly #cameras = new CubeCamera(1, 10, null as never)
  /** Zenith in world space. */
  readonly #up = uniform(new Vector3()).setGroup(renderGroup)
  readonly #box: Mesh<BoxGeometry, NodeMaterial>
  #generator: PMREMGenerator | null = null
  #renderer: Renderer | null = null
  #filtered: CubeRenderTarget | null = null

  /** @param size - Texels along the edge of a face, a power of two. */
  constructor(atmosphere: Atmosphere, size: number) {
    this.#atmosphere = atmosphere
    this.#view = viewNodes(atmosphere, this.camera)
    this.#faces = new CubeRenderTarget(size, {
      type: HalfFloatType,
      colorSpace: LinearSRGBColorSpace,
      depthBuffer: false,
      generateMipmaps: false
    })
    this.#faces.texture.name = 'SkyEnvironment'
    const material = new NodeMaterial()
    material.name = 'Welkin.SkyEnvironment'
    material.side = BackSide
    material.blending = NoBlending
    material.depthTest = material.depthWrite = material.toneMapped = material.fog = false
    material.fragmentNode = Fn(() => {
      const direction = positionWorldDirection.toConst() as Vec3
      const height = direction.dot(this.#up).sub(this.#view.eye.cosHorizon).toConst()
      const isNear = height.lessThan(0).and(height.greaterThan(-MARGIN / size))
      // With the world's axes a direction in view space is one in world space.
      const raised = direction.add(this.#up.mul(isNear.select(height.negate().add(1e-4), 0)))
      const mapped = this.#view.toMapped(raised).normalize().toConst() as Vec3
      return vec4(skyColor(this.#view, mapped, null), 1)
    })()
    this.#box = new Mesh(new BoxGeometry(5, 5, 5), material)
  }

  /** The filtered map, once there is one. */
  get texture(): Texture | null {
    return this.#filtered?.texture ?? null
  }

  /** Looks from a camera's place at the sky as it is now; the steps that follow draw that. */
  aim(renderer: Renderer, from: PerspectiveCamera['matrixWorld']): void {
    this.camera.matrixWorld.setPosition(_position.setFromMatrixPosition(from))
    const { up, viewToMapped } = this.#atmosphere.update(renderer, this.camera)
    this.#up.value.copy(up).applyMatrix3(_rotation.copy(viewToMapped).transpose()).normalize()
  }

  /**
   * Draws a face, or filters all of them.
   *
   * @param step - In [0, {@link SKY_CUBE_STEPS}), in that order.
   */
  draw(renderer: Renderer, step: number): void {
    const view = this.#atmosphere.viewOf(this.camera)
    if (view === undefined || view.eye === null) return
    const state = RendererUtils.resetRendererState(renderer, {} as never)
    const isPresenting = renderer.xr.enabled
    renderer.xr.enabled = false
    renderer.setMRT(null)
    if (step < 6) this.#drawFace(renderer, view, step)
    else this.#filter(renderer)
    renderer.xr.enabled = isPresenting
    RendererUtils.restoreRendererState(renderer, state)
  }

  #drawFace(renderer: Renderer, view: AtmosphereView, face: number): void {
    const { layers, sun, tables } = this.#atmosphere
    // Another camera may have taken the sky volume since the last face.
    view.slot = sun.volumes.volumeFor(renderer, view.eye!, tables.version).slot
    for (const layer of layers) layer.prepare?.(renderer, view)
    this.#view.update({ camera: this.camera })
    for (const layer of layers) layer.update?.(view)
    if (this.#cameras.coordinateSystem !== renderer.coordinateSystem) {
      this.#cameras.coordinateSystem = renderer.coordinateSystem
      this.#cameras.updateCoordinateSystem()
    }
    renderer.setRenderTarget(this.#faces, face)
    renderer.render(this.#box, this.#cameras.children[face] as PerspectiveCamera)
  }

  #filter(renderer: Renderer): void {
    if (this.#renderer !== renderer) {
      this.#generator?.dispose()
      this.#generator = new PMREMGenerator(renderer)
      this.#renderer = renderer
    }
    this.#filtered = this.#generator!.fromCubemap(this.#faces.texture, this.#filtered)
  }

  /** Frees GPU memory; it can be drawn again. */
  dispose(): void {
    this.#faces.dispose()
    this.#filtered?.dispose()
    this.#generator?.dispose()
    this.#generator = this.#renderer = null
    this.#box.geometry.dispose()
    this.#box.material.dispose()
  }
}
