import { DataTexture, FloatType, NearestFilter, RenderTarget, RGBAFormat } from 'three'
import {
  Discard,
  Fn,
  If,
  int,
  ivec2,
  screenCoordinate,
  textureLoad,
  uniform,
  vec4
} from 'three/tsl'
import type { WebGPURenderer } from 'three/webgpu'
import { FragmentPass } from '../../../packages/atmosphere/src/tables/FragmentPass'
import type { Float, Vec4 } from '../../../packages/atmosphere/src/tsl-types'
import { readPicture } from '../../gpu/harness/picture'
import type { RayRequest } from '../request'

const COLUMNS = 64

/** A ray, as the shader sees it. */
export interface RayNodes {
  cosView: Float
  cosViewLight: Float
  distance: Float
}

/** Rays from many viewpoints, a pixel each, drawn viewpoint by viewpoint. */
export class RayBatch {
  readonly #count: number
  readonly #viewpoints: Set<number>
  readonly #source: DataTexture
  readonly #target: RenderTarget
  readonly #pass: FragmentPass
  readonly #viewpoint = uniform(0)

  /**
   * @param rays - With the number of each one's viewpoint.
   * @param body - Function of a ray.
   */
  constructor(rays: (RayRequest & { viewpoint: number })[], body: (ray: RayNodes) => Vec4) {
    const rows = Math.max(Math.ceil(rays.length / COLUMNS), 1)
    const texels = new Float32Array(4 * COLUMNS * rows).fill(-1)
    rays.forEach(({ cosView, cosViewLight, distance = 0, viewpoint }, i) =>
      texels.set([cosView, cosViewLight, distance, viewpoint], 4 * i)
    )
    this.#count = rays.length
    this.#viewpoints = new Set(rays.map(ray => ray.viewpoint))
    this.#source = new DataTexture(texels, COLUMNS, rows, RGBAFormat, FloatType)
    this.#source.minFilter = this.#source.magFilter = NearestFilter
    this.#source.needsUpdate = true
    this.#target = new RenderTarget(COLUMNS, rows, { type: FloatType, depthBuffer: false })
    this.#target.texture.minFilter = this.#target.texture.magFilter = NearestFilter
    this.#pass = new FragmentPass(
      'Validation',
      Fn(() => {
        const pixel = ivec2(int(screenCoordinate.x), int(screenCoordinate.y))
        const ray = textureLoad(this.#source, pixel).toConst()
        If(ray.w.notEqual(this.#viewpoint), () => {
          Discard()
        })
        return vec4(
          body({
            cosView: ray.x,
            cosViewLight: ray.y,
            distance: ray.z
          })
        )
      })()
    )
  }

  /** Draws the rays of one viewpoint. */
  render(renderer: WebGPURenderer, viewpoint: number): void {
    if (!this.#viewpoints.has(viewpoint)) return
    this.#viewpoint.value = viewpoint
    this.#pass.render(renderer, this.#target)
  }

  /** Four numbers per ray; frees what the batch holds. */
  async read(renderer: WebGPURenderer): Promise<number[]> {
    // A target that nothing was drawn to does not exist yet.
    const pixels = this.#count === 0 ? [] : (await readPicture(renderer, this.#target)).data
    for (const owned of [this.#source, this.#target, this.#pass]) owned.dispose()
    return Array.from(pixels).slice(0, 4 * this.#count)
  }
}
