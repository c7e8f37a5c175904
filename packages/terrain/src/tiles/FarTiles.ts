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

/** Code that a tile needs. */
const codeOf = (tile: Tile, sight: Sight): GroundDetail => {
  const footprint = leastFootprint(tile, sight)
  return footprint > LEAST_FOOTPRINTS[0] ? 0 : footprint > LEAST_FOOTPRINTS[1] ? 1 : 2
}

/**
 * Tiles in view that a material of less code shows the same; they are drawn after the others. Shadow maps are drawn by the terrain itself.
 */
class FarTiles extends Mesh<InstancedBufferGeometry, MeshStandardNodeMaterial> {
  constructor(
    terrain: TileMesh,
    geometry: InstancedBufferGeometry,
    material: MeshStandardNodeMaterial
  ) {
    super(geometry, material)
    this.name = 'Terrain.far'
    this.frustumCulled = false
    this.matrixAutoUpdate = this.matrixWorldAutoUpdate = false
    this.matrixWorld = terrain.matrixWorld
    for (const name of SHARED) {
      Object.defineProperty(this, name, { get: () => terrain[name], set() {} })
    }
    terrain.add(this)
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
 *
 * Once somebody has changed the terrain's material all tiles are drawn with that.
 */
export function farTiles(
  terrain: TileMesh,
  grid: () => InstancedBufferGeometry,
  materialOf: (code: GroundDetail) => MeshStandardNodeMaterial
): TakeFar {
  const { material: own } = terrain
  const properties = Object.entries(own).filter(([name]) => name !== 'version')
  const meshes = ([1, 0] as const).map(code => new FarTiles(terrain, grid(), materialOf(code)))
  terrain.geometry.addEventListener('dispose', () => {
    for (const { geometry, material } of meshes) {
      geometry.dispose()
      material.dispose()
    }
  })
  return ({ tiles, inView }, { position, seaLevel }, camera, toECEF, renderer, write) => {
    const { material } = terrain
    const isUntouched =
      material === own &&
      properties.every(([name, value]) => (material as never)[name] === value) &&
      meshes.every(({ parent }) => parent === terrain)
    const { elements } = camera.projectionMatrix
    const lines = renderer.getRenderTarget()?.height ?? renderer.getDrawingBufferSize(size).y
    forward.setFromMatrixColumn(camera.matrixWorld, 2).negate().transformDirection(toECEF)
    const pixel = elements[15] === 1 ? 0 : 2 / Math.abs(elements[5]) / lines
    const sight = { position, seaLevel, forward, pixel }
    const left: Tile[] = []
    const parts = meshes.map((): Tile[] => [])
    for (const tile of tiles.slice(0, inView)) {
      const code = isUntouched ? codeOf(tile, sight) : 2
      ;(code === 2 ? left : parts[1 - code]).push(tile)
    }
    for (const [n, { geometry }] of meshes.entries()) {
      write(geometry, parts[n])
      geometry.instanceCount = parts[n].length
    }
    return { tiles: [...left, ...parts.flat(), ...tiles.slice(inView)], inView: left.length }
  }
}
