import {
  MathUtils,
  Matrix3,
  Matrix4,
  NearestFilter,
  RedFormat,
  RepeatWrapping,
  Vector3
} from 'three'
import type { RenderTarget, DepthTexture } from 'three'
import { texture } from 'three/tsl'
import type { Renderer, TextureNode } from 'three/webgpu'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import type { SphericalSpace } from '../view/cpu/spherical'
import type { ShadowMap } from './shadowMaps'
import { occluderAngle, type DepthStorage, type ShadowMapNodes } from './tsl/occluderAngle'
import { matrix4, number, vector2, vector3, vector4 } from '../uniforms'

/** Greatest distance over that up to which columns are even. */
const GROWTH = 1000

const _axes = new Matrix4()
const _linear = new Matrix3()
const _toMap = new Matrix4()
const _fromMap = new Matrix4()
const _corner = new Vector3()
const _end = new Vector3()

/** A view as far as the map asks it. */
interface PolarView {
  readonly up: Vector3
  readonly lightDirection: Vector3
  readonly camera: { readonly matrixWorld: Matrix4 }
}

/**
 * Shadow map in polar coordinates about the camera with the source of light as pole: for each ray of light the
 * angle of its first occluder. A view ray stays in one row of it, whatever its length; a row's texels
 * are a third of a degree wide, finer than the sun's disc, and its columns grow with the distance.
 */
export class SunPolarMap {
  readonly target: RenderTarget
  readonly map: TextureNode
  readonly frame = {
    across: vector3(),
    along: vector3(),
    perMeter: number(1),
    logScale: number(1),
    logOffset: number(),
    size: vector2(),
    texelSize: vector2()
  }
  /** Greatest ρ of a shadow map [m]; 0 without maps. */
  readonly maximumRho = number()
  /** Part of the light that the shadows take [–]. */
  readonly intensity = number(1)
  #sources: ShadowMapNodes[] = []
  #isCompared = false
  #pass: FragmentPass | null = null

  constructor() {
    this.target = tableTarget('Welkin.LightShafts', 1, 1, 1, NearestFilter)
    const [map] = this.target.textures
    map.format = RedFormat
    map.wrapT = RepeatWrapping
    this.map = texture(map)
  }

  /**
   * Draws it for a camera.
   *
   * @param size - Directions around the light (`rows`), and distances from its line to the camera (`columns`).
   */
  update(
    renderer: Renderer,
    view: PolarView,
    space: SphericalSpace,
    maps: readonly ShadowMap[],
    { rows, columns }: { readonly rows: number; readonly columns: number }
  ): void {
    this.maximumRho.value = 0
    // Without maps, too: what has drawn with the texture in this frame must find it at its end.
    this.target.setSize(columns, rows)
    this.frame.size.value.set(columns, rows)
    this.frame.texelSize.value.set(1 / columns, 1 / rows)
    if (maps.length === 0) return
    this.#setSources(renderer, maps)
    this.#setFrame(view, space, maps)
    this.#pass!.render(renderer, this.target)
  }

  /** Compiles the shader anew when there are more or fewer maps, or such that are read in another way. */
  #setSources(renderer: Renderer, maps: readonly ShadowMap[]): void {
    const isWebGPU = 'isWebGPUBackend' in renderer.backend
    const isCompared = !isWebGPU && maps.some(({ depth }) => depth.compareFunction !== null)
    if (this.#sources.length !== maps.length || this.#isCompared !== isCompared) {
      this.#isCompared = isCompared
      this.#sources = maps.map(({ depth }) => ({
        depth: texture(depth) as TextureNode & { value: DepthTexture },
        size: vector2(),
        matrix: matrix4(),
        bounds: vector4(),
        metersPerDepth: number()
      }))
      const storage: DepthStorage = { isReversed: renderer.reversedDepthBuffer, isCompared }
      this.#pass?.dispose()
      this.#pass = new FragmentPass(
        'Welkin.LightShafts',
        occluderAngle(this.frame, this.#sources, storage)
      )
    }
  }

  #setFrame(
    { up, lightDirection, camera }: PolarView,
    space: SphericalSpace,
    maps: readonly ShadowMap[]
  ): void {
    const { across, along, perMeter, logScale, logOffset, size } = this.frame
    across.value.crossVectors(up, lightDirection)
    if (across.value.lengthSq() < 1e-12) across.value.set(up.z, up.x, up.y).cross(lightDirection)
    across.value.normalize()
    along.value.crossVectors(lightDirection, across.value)
    let [least, greatest] = [Infinity, 0]
    const distance = (x: number, y: number): number => {
      _corner.set(x, y, 0.5).applyMatrix4(_fromMap)
      return _corner.addScaledVector(lightDirection, -_corner.dot(lightDirection)).length()
    }
    maps.forEach(({ depth, matrix, bounds }, i) => {
      const source = this.#sources[i]
      const { width, height } = depth.image as { width: number; height: number }
      source.depth.value = depth
      source.size.value.set(width, height)
      source.bounds.value.copy(bounds)
      // From the camera in the mapped space to world axes, to the world, to the map; float64 all the way.
      space.displacement(_axes.identity(), _linear)
      _toMap.setFromMatrix3(_linear.invert()).premultiply(_axes.copyPosition(camera.matrixWorld))
      _toMap.premultiply(matrix)
      source.matrix.value.copy(_toMap)
      _fromMap.copy(_toMap).invert()
      const viewpoint = _end.set(0, 0, 0).applyMatrix4(_toMap)
      const { x, y, z, w } = bounds
      least = Math.min(
        least,
        distance(MathUtils.clamp(viewpoint.x, x, z), MathUtils.clamp(viewpoint.y, y, w))
      )
      greatest = Math.max(greatest, distance(x, y), distance(z, y), distance(x, w), distance(z, w))
      const e = _toMap.elements
      source.metersPerDepth.value = 1 / lightDirection.dot(_end.set(e[2], e[6], e[10]))
    })
    perMeter.value = GROWTH / greatest
    const last = Math.log2(1 + GROWTH)
    const first = Math.min(Math.log2(1 + least * perMeter.value), last - 1e-3)
    logScale.value = (size.value.x - 1) / (last - first)
    logOffset.value = -first * logScale.value
    this.maximumRho.value = greatest
    this.intensity.value = maps[0].intensity
  }

  /** Frees the map. */
  dispose(): void {
    this.target.dispose()
    this.#pass?.dispose()
    this.#pass = null
    this.#sources = []
    this.maximumRho.value = 0
  }
}
