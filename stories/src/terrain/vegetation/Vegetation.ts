import type { Terrain } from '@welkin/terrain'
import type { BufferGeometry, Mesh } from 'three'
import { Frustum, Group, MathUtils, Matrix4, Vector3, type Camera } from 'three'
import type { NodeMaterial, WebGPURenderer } from 'three/webgpu'
import { branchedSpruce } from '../../valley/treeShapes'
import { randomSequence } from '../../random'
import { broadleaf } from './broadleaf'
import { createFlowers, FLOWERS, GOES } from './flowers'
import { createGrass, GRASSES } from './grass'
import { createImpostors, drawPictures, type TreePictures } from './impostors'
import { NearTrees } from './NearTrees'
import { CellGrounds } from './CellGrounds'
import { PlantCells, type GroundCell, type PlantCellsOptions, type Thinning } from './PlantCells'
import { plantUniforms } from './plantShader'
import { valueNoise } from './valueNoise'

/** Distance from their frame's origin beyond which plants get another one: float32 is too coarse for blades there [m]. */
const FRAME_REACH = 3000

/** Height over the ground from which nothing is planted [m]. */
const CEILING = 1500

/** Distance within which trees have branches, and distances between which their pictures go [m]. */
const BRANCHES = 90
const TREES_GO = [780, 860] as const

/** Distance that the viewer goes before trees near by are chosen anew [m]. */
const STEP = 3

const frustum = new Frustum()
const view = new Matrix4()

const { clamp, lerp, smoothstep } = MathUtils

/** Height over the sea between which plains dry out, as the ground's colour has it [m]. */
const LOWLAND = [60, 420] as const

/** Straw in the grass of a cell, as the ground's colour has it. */
const strawOf = ({ shares, overSea }: GroundCell): number =>
  0.5 *
  smoothstep(
    0.6 * shares.patch + 1.5 * shares.climate + 0.55 * (1 - smoothstep(overSea, ...LOWLAND)),
    -0.3,
    0.8
  )

/** Share of the ground that grass grows on: woods have some. */
const grassOf = ({ shares }: GroundCell): number => shares.grass + 0.3 * shares.forest

/** Numbers that have to do with each other within some metres, and lie far apart for different seeds. */
const clumps = { dense: [2.3, 11], high: [9, 23], dry: [14, 37], flowers: [7, 53], kinds: [16, 71] }

/** Clump of a place in a cell, in [0, 1]. */
function clumpAt(of: keyof typeof clumps, cell: GroundCell, x: number, z: number): number {
  const [size, seed] = clumps[of]
  return valueNoise((cell.x + x * cell.side) / size, (cell.z + z * cell.side) / size, seed)
}

/** Order in which places of a cell are planted: any first part of them is spread over all of it. */
function orderOf(most: number): number[] {
  const random = randomSequence(most)
  return Array.from({ length: most }, (_, i) => [random(), i])
    .sort(([a], [b]) => a - b)
    .map(([, i]) => i)
}

function sowGrass(cell: GroundCell, order: readonly number[]): void {
  const { random } = cell
  const share = grassOf(cell)
  const straw = strawOf(cell)
  const side = Math.round(Math.sqrt(order.length))
  for (const i of order) {
    const [x, z] = [((i % side) + random()) / side, (Math.floor(i / side) + random()) / side]
    // All numbers are drawn, so that others stay where they are.
    const [chance, size, dry] = [random(), random(), random()]
    const dense = lerp(0.6, 1.5, smoothstep(clumpAt('dense', cell, x, z), 0.2, 0.6))
    if (chance > (1.3 * share - 0.15) * dense) continue
    const high = clumpAt('high', cell, x, z)
    const long = lerp(0.6, 1.55, smoothstep(high, 0.3, 0.75)) * (0.65 + 0.6 * size)
    // Here and there one stands out, more of them in high grass.
    const tall = dry > 0.985 - 0.06 * high ? 1.45 : 1
    const spot = 0.6 * (clumpAt('dry', cell, x, z) - 0.55)
    cell.plant(x, z, long * tall, straw + spot + 0.25 * (dry - 0.5))
  }
}

function sowFlowers(cell: GroundCell, order: readonly number[]): void {
  const { random, shares } = cell
  const open = clamp(2 * shares.grass - 0.8, 0, 1)
  for (let i = 0; i < order.length; i++) {
    const [x, z, chance, size, other] = [random(), random(), random(), random(), random()]
    const patch = smoothstep(clumpAt('flowers', cell, x, z), 0.45, 0.85)
    if (chance > open * (0.05 + 0.95 * patch)) continue
    const own = Math.floor(FLOWERS * 0.999 * clumpAt('kinds', cell, x, z) + 0.8 * (other - 0.5))
    cell.plant(x, z, 0.55 + 0.6 * size, clamp(own, 0, FLOWERS - 1))
  }
}

/** Kinds of trees: their shape, and sizes inside of a wood and at its edge. */
const TREES = [
  { shape: () => branchedSpruce(15, 7), inside: 0.8, edge: 0.3, open: 0.004, size: [0.6, 2] },
  { shape: () => broadleaf('lime'), inside: 0.12, edge: 0.55, open: 0.012, size: [0.28, 1.5] },
  { shape: () => broadleaf('birch'), inside: 0.08, edge: 0.35, open: 0.006, size: [0.4, 1.2] }
] as const

function sowTrees(
  cell: GroundCell,
  order: readonly number[],
  { inside, edge, open, size }: (typeof TREES)[number]
): void {
  const { random, shares } = cell
  const side = Math.round(Math.sqrt(order.length))
  const wood = shares.forest
  // Between meadow and wood bushes and young trees come first.
  const atEdge = smoothstep(wood, 0.03, 0.3) * (1 - smoothstep(wood, 0.45, 0.9))
  const share = inside * wood ** 1.5 + edge * atEdge + open * Math.max(shares.grass - 0.2, 0)
  for (const i of order) {
    const [x, z] = [((i % side) + random()) / side, (Math.floor(i / side) + random()) / side]
    const [chance, age, light] = [random(), random(), random()]
    if (chance > share) continue
    const old = age ** lerp(0.8, 2.6, atEdge)
    cell.plant(x, z, lerp(size[0], size[1], old), 0.7 + 0.55 * light)
  }
}

/** Ground of cells, twice as many as are held. */
const groundsOf = (side: number, count: number): CellGrounds =>
  new CellGrounds(side, 2, 2 * count ** 2)

/** Cells of a kind of plants: their ground, their number along an edge, most plants, and what is planted. */
function cellsOf(
  [grounds, count, most]: readonly [CellGrounds, number, number],
  drawn: Pick<PlantCellsOptions, 'near' | 'far' | 'tall'> & { thinning?: Thinning },
  seed: number,
  sow: (cell: GroundCell, order: readonly number[]) => void
): PlantCells {
  const order = orderOf(most)
  const options = { grounds, count, most, thinning: null, ...drawn }
  return new PlantCells({ ...options, sow: cell => sow(cell, order) }, seed)
}

/** Distances between which tufts of a kind are drawn [m]. */
const grassReach = ({ reach, thinning }: (typeof GRASSES)[keyof typeof GRASSES]) => ({
  near: reach[0],
  far: reach[3],
  tall: 0.8,
  thinning
})

/**
 * Grass, flowers and trees on a terrain, about the viewer: a sample to begin from. Plants stand at `terrain.heightBelow` where
 * `groundSharesAt` says that their ground is; each kind is one draw call, trees are two, the farther ones as pictures.
 *
 * ```ts
 * const vegetation = new Vegetation(renderer, terrain)
 * scene.add(vegetation)
 * vegetation.update(camera, seconds) // each frame
 * ```
 *
 * Only what is in view of that camera is drawn.
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
  /** Matrix from the plants' frame to clip space, as plants were chosen last. */
  readonly #view = new Matrix4()
  #hasFrame = false

  constructor(renderer: WebGPURenderer, terrain: Terrain) {
    super()
    this.#terrain = terrain
    const uniforms = this.#uniforms
    const near = cellsOf([groundsOf(2, 22), 22, 64], grassReach(GRASSES.near), 1, sowGrass)
    const far = cellsOf([groundsOf(6, 30), 30, 81], grassReach(GRASSES.far), 2, sowGrass)
    const meadow = { near: 0, far: GOES[1], tall: 0.6 }
    const flowers = cellsOf([groundsOf(4, 24), 24, 90], meadow, 3, sowFlowers)
    this.add(createGrass('near', near, uniforms), createGrass('far', far, uniforms))
    this.add(createFlowers(flowers, uniforms))
    const woods = groundsOf(25, 72)
    this.#trees = TREES.map((tree, i) => {
      const drawn = { near: BRANCHES, far: 1.1 * TREES_GO[1], tall: 22 }
      const cells = cellsOf([woods, 72, 16], drawn, 4 + i, (cell, order) =>
        sowTrees(cell, order, tree)
      )
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
    const { sunDirection } = this.#terrain.atmosphere
    this.#uniforms.sun.value.copy(sunDirection).transformDirection(this.#toFrame)
    let isPlanted = false
    for (const cells of this.#cells) {
      if (!cells.update(this.#terrain, this.matrix, viewer.x, viewer.z, until)) continue
      isPlanted = true
      if (this.#trees.some(tree => tree.cells === cells)) this.#chosenAt.x = Infinity
    }
    this.#choose(camera, viewer, isPlanted)
    if (viewer.distanceTo(this.#chosenAt) < STEP) return
    this.#chosenAt.copy(viewer)
    for (const { near } of this.#trees) near.choose(viewer)
  }

  /** Chooses plants in view of a camera, if anything has changed. */
  #choose(camera: Camera, viewer: Vector3, isPlanted: boolean): void {
    view
      .copy(camera.matrixWorld)
      .invert()
      .multiply(this.matrix)
      .premultiply(camera.projectionMatrix)
    if (!isPlanted && view.equals(this.#view)) return
    this.#view.copy(view)
    frustum.setFromProjectionMatrix(view, camera.coordinateSystem)
    // Left, right, top and bottom: near and far depend on the kind of depth.
    const planes = frustum.planes.slice(0, 4)
    for (const cells of this.#cells) cells.choose(viewer, planes)
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
