import type { Terrain } from '@welkin/terrain'
import type { BufferGeometry, Mesh } from 'three'
import { Group, MathUtils, Matrix4, Vector3, type Camera } from 'three'
import type { NodeMaterial, WebGPURenderer } from 'three/webgpu'
import { branchedSpruce, leafyTree } from '../../valley/treeShapes'
import { createFlowers, FLOWERS } from './flowers'
import { createGrass } from './grass'
import { createImpostors, drawPictures, type TreePictures } from './impostors'
import { NearTrees } from './NearTrees'
import { PlantCells, type GroundCell } from './PlantCells'
import { plantUniforms } from './plantShader'

/** Distance from their frame's origin beyond which plants get another one: float32 is too coarse for blades there [m]. */
const FRAME_REACH = 3000

/** Height over the ground from which nothing is planted [m]. */
const CEILING = 1500

/** Distance within which trees have branches, and distances between which their pictures go [m]. */
const BRANCHES = 90
const TREES_GO = [780, 860] as const

/** Distance that the viewer goes before trees near by are chosen anew [m]. */
const STEP = 3

const { smoothstep } = MathUtils

/** Straw in the grass of a cell, as the ground's colour has it. */
const strawOf = ({ shares }: GroundCell): number =>
  0.75 * smoothstep(0.6 * shares.patch + 1.5 * shares.climate, -0.3, 0.8)

/** Share of the ground that grass grows on: woods have some. */
const grassOf = ({ shares }: GroundCell): number => shares.grass + 0.3 * shares.forest

function sowGrass(cell: GroundCell, most: number): void {
  const { random } = cell
  const share = grassOf(cell)
  const [straw, long] = [strawOf(cell), 0.75 + 0.5 * random()]
  const side = Math.round(Math.sqrt(most))
  for (let i = 0; i < most; i++) {
    const [x, z] = [((i % side) + random()) / side, (Math.floor(i / side) + random()) / side]
    // All numbers are drawn, so that others stay where they are.
    const [chance, size, dry] = [random(), random(), random()]
    if (chance > 1.3 * share - 0.15) continue
    cell.plant(x, z, long * (0.6 + 0.7 * size), straw + 0.25 * (dry - 0.5))
  }
}

function sowFlowers(cell: GroundCell, most: number): void {
  const { random, shares } = cell
  const kind = Math.floor(FLOWERS * random())
  const other = Math.floor(FLOWERS * random())
  const many = random() ** 2 * most * MathUtils.clamp(2 * shares.grass - 0.8, 0, 1)
  for (let i = 0; i < many; i++) {
    cell.plant(random(), random(), 0.5 + 0.6 * random(), random() < 0.8 ? kind : other)
  }
}

/** Kinds of trees: their shape, and their part of the trees of a wood. */
const TREES = [
  { shape: () => branchedSpruce(9, 6), part: 0.75, size: [0.8, 1.9] },
  { shape: () => leafyTree('lime', 14), part: 0.25, size: [0.7, 1.4] }
] as const

function sowTrees(cell: GroundCell, most: number, { part, size }: (typeof TREES)[number]): void {
  const { random, shares } = cell
  const side = Math.round(Math.sqrt(most))
  const open = Math.max(shares.grass - 0.2, 0) * 0.012
  for (let i = 0; i < most; i++) {
    const [x, z] = [((i % side) + random()) / side, (Math.floor(i / side) + random()) / side]
    const [chance, age, light] = [random(), random(), random()]
    if (chance > part * (0.95 * shares.forest ** 1.5 + open)) continue
    cell.plant(x, z, size[0] + (size[1] - size[0]) * age ** 1.5, 0.8 + 0.4 * light)
  }
}

/** Cells of a kind of plants: side [m], their number along an edge, most plants, and what is planted. */
const cellsOf = (
  side: number,
  count: number,
  most: number,
  seed: number,
  sow: (cell: GroundCell, most: number) => void
): PlantCells => new PlantCells({ side, count, most, steps: 2, sow: cell => sow(cell, most) }, seed)

/**
 * Grass, flowers and trees on a terrain, about the viewer: a sample to begin from. Plants stand at `terrain.heightBelow` where
 * `groundSharesAt` says that their ground is; each kind is one draw call, trees are two, the farther ones as pictures.
 *
 * ```ts
 * const vegetation = new Vegetation(renderer, terrain)
 * scene.add(vegetation)
 * vegetation.update(camera, seconds) // each frame
 * ```
 */
export class Vegetation extends Group {
  readonly #terrain: Terrain
  readonly #uniforms = plantUniforms()
  readonly #cells: PlantCells[]
  readonly #trees: {
    cells: PlantCells
    near: NearTrees
    pictures: TreePictures
    shape: BufferGeometry
  }[]
  readonly #viewer = new Vector3()
  readonly #chosenAt = new Vector3(Infinity, 0, 0)
  readonly #toFrame = new Matrix4()
  #hasFrame = false

  constructor(renderer: WebGPURenderer, terrain: Terrain) {
    super()
    this.#terrain = terrain
    const uniforms = this.#uniforms
    const near = cellsOf(2, 24, 64, 1, sowGrass)
    const far = cellsOf(6, 30, 81, 2, sowGrass)
    const flowers = cellsOf(4, 22, 90, 3, sowFlowers)
    this.add(createGrass('near', near, uniforms), createGrass('far', far, uniforms))
    this.add(createFlowers(flowers, uniforms))
    this.#trees = TREES.map((tree, i) => {
      const cells = cellsOf(25, 72, 16, 4 + i, (cell, most) => sowTrees(cell, most, tree))
      const shape = tree.shape()
      const branches = new NearTrees(shape, cells, uniforms, BRANCHES)
      const pictures = drawPictures(renderer, shape)
      this.add(branches, createImpostors(pictures, cells, uniforms, BRANCHES, TREES_GO))
      return { cells, near: branches, pictures, shape }
    })
    this.#cells = [near, flowers, far, ...this.#trees.map(({ cells }) => cells)]
    this.matrixAutoUpdate = false
  }

  /**
   * Plants what the viewer has come near to.
   *
   * @param camera - With `matrixWorld` up to date.
   * @param seconds - Time that wind moves grass by [s].
   * @param budget - Time that it may take [ms].
   */
  update(camera: Camera, seconds: number, budget = 3): void {
    const until = performance.now() + budget
    const viewer = this.#viewer.setFromMatrixPosition(camera.matrixWorld)
    const { ellipsoid, worldToECEF } = this.#terrain.atmosphere
    const high = ellipsoid.heightAt(viewer.clone().applyMatrix4(worldToECEF))
    this.visible = high - this.#terrain.heightBelow(viewer) < CEILING
    if (!this.visible) return
    viewer.applyMatrix4(this.#toFrame)
    if (!this.#hasFrame || Math.hypot(viewer.x, viewer.z) > FRAME_REACH) {
      viewer.setFromMatrixPosition(camera.matrixWorld)
      this.#setFrame(viewer)
      viewer.applyMatrix4(this.#toFrame)
    }
    this.#uniforms.viewer.value.copy(viewer)
    this.#uniforms.time.value = seconds
    for (const cells of this.#cells) {
      if (!cells.update(this.#terrain, this.matrix, viewer.x, viewer.z, until)) continue
      if (this.#trees.some(tree => tree.cells === cells)) this.#chosenAt.x = Infinity
    }
    if (viewer.distanceTo(this.#chosenAt) < STEP) return
    this.#chosenAt.copy(viewer)
    for (const { near } of this.#trees) near.choose(viewer)
  }

  /** Lets plants count from below a place: y is up there, and 0 on the ellipsoid. */
  #setFrame(positionWorld: Vector3): void {
    const { ellipsoid, worldToECEF } = this.#terrain.atmosphere
    const foot = ellipsoid.footPoint(positionWorld.clone().applyMatrix4(worldToECEF))
    this.matrix.copy(worldToECEF).invert().multiply(ellipsoid.localYUpFrame(foot))
    this.matrixWorldNeedsUpdate = true
    this.updateMatrixWorld(true)
    this.#toFrame.copy(this.matrix).invert()
    for (const cells of this.#cells) cells.clear()
    this.#hasFrame = true
  }

  /** Frees geometries, materials and pictures; terrain and renderer are shared. */
  override dispose(): void {
    for (const { pictures, shape } of this.#trees) {
      shape.dispose()
      pictures.color.dispose()
      pictures.normal.dispose()
    }
    for (const mesh of this.children as Mesh[]) {
      mesh.geometry.dispose()
      ;(mesh.material as NodeMaterial).dispose()
    }
  }
}
