import { Mesh, Vector2, Vector3 } from 'three'
import type { Camera, InstancedBufferGeometry, Matrix4 } from 'three'
import type { MeshStandardNodeMaterial, Renderer } from 'three/webgpu'
import { LEAST_FOOTPRINTS, type GroundDetail } from '../surface/tsl/grain'
import type { Viewer } from './cpu/viewer'
import type { Tile } from './Tile'
import type { TileSelection } from './TileTree'

type TileMesh = Mesh<InstancedBufferGeometry, MeshStandardNodeMaterial>

/** Tiles to draw, those in view first, and the number of these. */
export type DrawnTiles = Pick<TileSelection, 'tiles' | 'inView'>

/** Properties that tiles far away have in common with their terrain. */
const SHARED = ['receiveShadow', 'renderOrder', 'layers'] as const

const point = new Vector3()
const forward = new Vector3()
const size = new Vector2()

/** View of a camera. ECEF axes. */
export interface Sight extends Pick<Viewer, 'position' | 'seaLevel'> {
  /** Unit vector along the middle of the view. */
  readonly forward: Vector3
  /** Height of a pixel over the focal length; 0 for parallel lines of sight [–]. */
  readonly pixel: number
}

/**
 * Least side of what a pixel shows of a tile, at most steep ground of a half; 0 where that is not known [m].
 *
 * A way δ along the ground at a distance d, at an angle θ to the middle of the view, is at most δ f / (d cos² θ) in the picture, with f the focal length.
 */
export function leastFootprint(
  { center, normal, radius, lowest, highest }: Tile,
  { position, seaLevel, ...view }: Sight
): number {
  const low = Math.max(lowest, seaLevel)
  const high = Math.max(highest, seaLevel)
  point
    .copy(center)
    .addScaledVector(normal, (low + high) / 2)
    .sub(position)
  const distance = point.length()
  const spread = Math.hypot(radius, Math.min(high - low, radius) / 2)
  if (spread >= distance) return 0
  const cosine = point.dot(view.forward) / distance
  const sine = Math.sqrt(Math.max(1 - cosine ** 2, 0))
  const part = spread / distance
  const least = cosine * Math.sqrt(1 - part ** 2) - sine * part
  return least > 0 ? (distance - spread) * least ** 2 * view.pixel : 0
}

/**
 * Tiles in view so far away that a material of less code shows the same; they are drawn after the others. Shadow maps are drawn by the terrain itself.
 *
 * Once somebody has changed the terrain's material there are none: all tiles are then drawn with that.
 */
export class FarTiles extends Mesh<InstancedBufferGeometry, MeshStandardNodeMaterial> {
  tiles: readonly Tile[] = []
  readonly #terrain: TileMesh
  readonly #material: MeshStandardNodeMaterial
  /** Properties of the terrain's material, as they were at first. */
  readonly #properties: [string, unknown][]

  /** @param footprint - Side of pixels on the ground from which on its material shows the same [m]. */
  constructor(
    terrain: TileMesh,
    geometry: InstancedBufferGeometry,
    material: MeshStandardNodeMaterial,
    readonly footprint: number
  ) {
    super(geometry, material)
    this.#terrain = terrain
    this.#material = terrain.material
    this.#properties = Object.entries(terrain.material).filter(([name]) => name !== 'version')
    this.name = 'Terrain.far'
    this.frustumCulled = false
    this.matrixAutoUpdate = this.matrixWorldAutoUpdate = false
    this.matrixWorld = terrain.matrixWorld
    for (const name of SHARED) {
      Object.defineProperty(this, name, { get: () => terrain[name], set() {} })
    }
    terrain.add(this)
  }

  /**
   * Takes the tiles that are far away.
   *
   * @param tiles - In view.
   * @returns The other ones.
   */
  take(tiles: readonly Tile[], sight: Sight): Tile[] {
    const terrain = this.#terrain
    const { material } = terrain
    const isUntouched =
      this.parent === terrain &&
      material === this.#material &&
      this.#properties.every(([name, value]) => (material as never)[name] === value)
    const isFar = (tile: Tile): boolean =>
      isUntouched && leastFootprint(tile, sight) > this.footprint
    const parts = [[], []] as Tile[][]
    for (const tile of tiles) parts[Number(isFar(tile))].push(tile)
    this.tiles = parts[1]
    this.geometry.instanceCount = this.tiles.length
    return parts[0]
  }

  /** The terrain itself finds hits of rays. */
  override raycast(): void {}
}

/**
 * Has tiles far away drawn by meshes of their own.
 *
 * @param toECEF - Rotation and scale of the world.
 * @param write - Writes tiles as instances of a geometry.
 * @returns All tiles, those first that remain in view.
 */
export type TakeFar = (
  drawn: DrawnTiles,
  viewer: Viewer,
  camera: Camera,
  toECEF: Matrix4,
  renderer: Renderer,
  write: (geometry: InstancedBufferGeometry, tiles: readonly Tile[]) => void
) => DrawnTiles

/**
 * Has tiles far away drawn with materials of less code, which show the same: for the option `far` of a terrain.
 *
 * ```ts
 * const terrain = new Terrain(atmosphere, new MountainHeights(), { far: farTiles })
 * ```
 */
export function farTiles(
  terrain: TileMesh,
  grid: () => InstancedBufferGeometry,
  materialOf: (code: GroundDetail) => MeshStandardNodeMaterial
): TakeFar {
  // Three draws what was made first first: what is near hides what is far.
  const meshes = ([1, 0] as const).map(
    code => new FarTiles(terrain, grid(), materialOf(code), LEAST_FOOTPRINTS[code])
  )
  terrain.geometry.addEventListener('dispose', () => {
    for (const { geometry, material } of meshes) {
      geometry.dispose()
      material.dispose()
    }
  })
  return ({ tiles, inView }, { position, seaLevel }, camera, toECEF, renderer, write) => {
    const { elements } = camera.projectionMatrix
    const lines = renderer.getRenderTarget()?.height ?? renderer.getDrawingBufferSize(size).y
    forward.setFromMatrixColumn(camera.matrixWorld, 2).negate().transformDirection(toECEF)
    const pixel = elements[15] === 1 ? 0 : 2 / Math.abs(elements[5]) / lines
    let left = tiles.slice(0, inView)
    const far: Tile[] = []
    for (const mesh of meshes.toReversed()) {
      left = mesh.take(left, { position, seaLevel, forward, pixel })
      write(mesh.geometry, mesh.tiles)
      far.push(...mesh.tiles)
    }
    return { tiles: [...left, ...far, ...tiles.slice(inView)], inView: left.length }
  }
}
