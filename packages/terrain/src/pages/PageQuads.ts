import {
  DynamicDrawUsage,
  BufferAttribute,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  NoBlending,
  OrthographicCamera
} from 'three'
import { Vector3, type RenderTarget } from 'three'
import { attribute, positionGeometry, varying, vec2, vec4 } from 'three/tsl'
import { NodeMaterial, RendererUtils } from 'three/webgpu'
import type { Renderer } from 'three/webgpu'
import { REFERENCE_STEP } from '../noise/tsl/latticeNoise'
import type { Tile } from '../tiles/Tile'
import type { Vec2, Vec4 } from '../tsl-types'
import type { PageAtlas } from './PageAtlas'
import type { PageUniforms } from './tsl/pageOutput'

/** Most pages of one drawing. */
export const MOST = 32

/** Attributes of an instance, four numbers each. */
const ATTRIBUTES = ['pageCube', 'pageCenter', 'pageReference', 'pageSlot'] as const

const reference = new Vector3()
const point = new Vector3()

/** An instance's numbers as they are: a mean of three equal ones might be another. */
function flat(name: (typeof ATTRIBUTES)[number]): Vec4 {
  const handed = varying(attribute<'vec4'>(name, 'vec4'), `v_${name}`)
  handed.setInterpolation('flat')
  return handed
}

/** Squares over pages of an atlas, drawn all at once, each with the tile that its page is of. */
export class PageQuads {
  readonly #geometry = new InstancedBufferGeometry()
  readonly #attributes: readonly InstancedBufferAttribute[]
  readonly #camera = new OrthographicCamera()
  readonly #meshes: { mesh: Mesh; target: RenderTarget }[] = []
  readonly #columns: number
  readonly #place: Vec2
  #count = 0

  /** Tile of a pixel's page. */
  readonly tile: Omit<PageUniforms, 'radii' | 'figure' | 'seed'>

  constructor({ columns, capacity }: PageAtlas) {
    this.#columns = columns
    const corner = attribute<'vec4'>('pageSlot', 'vec4').xy.add(positionGeometry.xy)
    this.#place = corner.div(vec2(columns, capacity / columns))
    const [cube, center, reference, slot] = ATTRIBUTES.map(flat)
    this.tile = {
      cube: cube.xyz,
      face: cube.w,
      center: center.xyz,
      extent: center.w,
      reference: reference.xyz,
      shortest: reference.w,
      row: slot.z
    }
    const geometry = this.#geometry
    const corners = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0])
    geometry.setAttribute('position', new BufferAttribute(corners, 3))
    geometry.setIndex([0, 2, 1, 1, 2, 3])
    this.#attributes = ATTRIBUTES.map(name => {
      const values = new InstancedBufferAttribute(new Float32Array(4 * MOST), 4)
      geometry.setAttribute(name, values.setUsage(DynamicDrawUsage))
      return values
    })
  }

  /**
   * Adds a shader to draw pages with.
   *
   * @param output - Value of a texel.
   * @param at - Place of a vertex in the target, in [0, 1]: that of its page in the atlas.
   */
  addPass(name: string, output: Vec4, target: RenderTarget, at: Vec2 = this.#place): void {
    const material = Object.assign(new NodeMaterial(), {
      name: `Welkin.Terrain.${name}`,
      blending: NoBlending,
      depthTest: false,
      depthWrite: false,
      toneMapped: false,
      fog: false,
      // Rows count from the top.
      vertexNode: vec4(at.x.mul(2).sub(1), at.y.mul(-2).add(1), 0, 1),
      fragmentNode: output
    })
    const mesh = new Mesh(this.#geometry, material)
    mesh.frustumCulled = false
    this.#meshes.push({ mesh, target })
  }

  /**
   * Adds a page to the next drawing.
   *
   * @param shortest - Shortest wavelength that vertices show [m].
   * @returns Its number in the drawing, less than {@link MOST}.
   */
  add(tile: Tile, slot: number, shortest: number): number {
    const row = this.#count++
    const n = 4 * row
    const [cubes, centers, references, slots] = this.#attributes.map(({ array }) => array)
    tile.cube.toArray(cubes, n)
    cubes[n + 3] = tile.face
    reference.copy(tile.center).divideScalar(REFERENCE_STEP).round()
    const center = point.copy(tile.center).addScaledVector(reference, -REFERENCE_STEP)
    center.toArray(centers, n)
    centers[n + 3] = tile.extent
    reference.toArray(references, n)
    references[n + 3] = shortest
    slots[n] = slot % this.#columns
    slots[n + 1] = Math.floor(slot / this.#columns)
    slots[n + 2] = row
    return row
  }

  /** Draws the pages that were added; the renderer is left as it was. */
  draw(renderer: Renderer): void {
    if (this.#count === 0) return
    this.#geometry.instanceCount = this.#count
    for (const values of this.#attributes) values.needsUpdate = true
    this.#count = 0
    const state = RendererUtils.resetRendererState(renderer, {} as never)
    renderer.autoClear = false
    for (const { mesh, target } of this.#meshes) {
      renderer.setRenderTarget(target)
      renderer.render(mesh, this.#camera)
    }
    RendererUtils.restoreRendererState(renderer, state)
  }

  dispose(): void {
    this.#count = 0
    this.#geometry.dispose()
    for (const { mesh } of this.#meshes) (mesh.material as NodeMaterial).dispose()
  }
}
