import { Color, DoubleSide, Group, InstancedMesh, Vector3 } from 'three'
import type { BufferGeometry, Matrix4, PerspectiveCamera } from 'three'
import type { SurfaceWater } from '@welkin/atmosphere'
import { disposeMeshes } from '../scene'
import { fallenLeaves, setFarFoliage, setFoliage } from './leaves'
import { VertexLitMaterial } from './VertexLitMaterial'

/** A tree: its place and size, and its brightness over that of its kind. */
export interface Tree {
  readonly matrix: Matrix4
  readonly color: Color
}

/** Distance that the camera moves, and cosine of its turn, before trees are sorted by distance anew [m]. */
const STEP = 10
const COS_TURN = Math.cos(0.15)

/**
 * Cosine of the angle from the direction of view beyond which trees of the last level are left out: the picture's corners
 * are 51° from it. Of a view that is steeper than this sine, none are.
 */
const COS_ASIDE = Math.cos(1.08)
const STEEP = 0.6

/** Part of a crown's upper side that snow covers, at most, and of one without leaves. */
const SNOWED = 0.55
const SNOWED_BARE = 0.6

/** Cosines of the slopes of a crown of needles between which snow comes to lie: its branches hold it where a roof would not. */
const NEEDLED = [-0.15, 0.6] as const

/** Cosines of the slopes of bare twigs that rime covers: it is on all sides. */
const TWIGGED = [-1.4, 0.6] as const

const _place = new Vector3()
const _direction = new Vector3()

/** Trees of a kind, drawn with fewer triangles the farther they are from the camera. */
export class Trees extends Group {
  readonly trees: readonly Tree[]
  readonly #distances: readonly number[]
  /** Levels of detail, the finest first. */
  readonly levels: readonly InstancedMesh[]
  readonly #sortedAt = new Vector3(Infinity, 0, 0)
  readonly #sortedTowards = new Vector3()

  /**
   * @param geometries - Finest to coarsest, with vertex colours.
   * @param distances - Distances from which each but the first is drawn [m].
   * @param leafy - Number of geometries that have leaves with gaps, see {@link setFoliage}.
   * @param winter - Rain and snow on them, and whether their leaves fall; null for no weather.
   */
  constructor(
    geometries: readonly BufferGeometry[],
    distances: readonly number[],
    trees: readonly Tree[],
    leafy: number,
    winter: { water: SurfaceWater; isBare: boolean } | null = null
  ) {
    super()
    this.trees = trees
    this.#distances = distances
    const near = new VertexLitMaterial({ side: DoubleSide, vertexColors: true })
    const isBare = winter?.isBare === true
    const snow = winter?.water.snowCoverNode ?? null
    const fallen = isBare && snow !== null ? fallenLeaves(snow) : null
    setFoliage(near, fallen)
    // Gaps are smaller than pixels elsewhere.
    const far = new VertexLitMaterial({ side: DoubleSide, vertexColors: true })
    if (fallen !== null) setFarFoliage(far, fallen)
    near.snowNode = far.snowNode = snow && snow.mul(isBare ? SNOWED_BARE : SNOWED)
    near.lying = far.lying = isBare ? TWIGGED : NEEDLED
    near.wetNode = far.wetNode = winter?.water.wetnessNode ?? null
    this.levels = geometries.map((geometry, level) => {
      const mesh = new InstancedMesh(geometry, level < leafy ? near : far, trees.length)
      mesh.setColorAt(0, new Color())
      mesh.castShadow = mesh.receiveShadow = true
      mesh.frustumCulled = false
      // Before the ground, of which they hide much.
      mesh.renderOrder = -1
      return mesh
    })
    this.add(...this.levels)
  }

  /**
   * Sorts the trees by distance if the camera has moved or turned far enough.
   *
   * @returns True if it did: other trees are drawn now.
   */
  update(camera: PerspectiveCamera): boolean {
    const { position } = camera
    camera.getWorldDirection(_direction)
    const isTurned = _direction.dot(this.#sortedTowards) < COS_TURN
    if (position.distanceTo(this.#sortedAt) < STEP && !isTurned) return false
    this.#sortedAt.copy(position)
    this.#sortedTowards.copy(_direction)
    const isSteep = Math.abs(_direction.y) > STEEP
    const last = this.#distances.length
    for (const level of this.levels) level.count = 0
    for (const { matrix, color } of this.trees) {
      _place.setFromMatrixPosition(matrix).sub(position)
      const distance = _place.length()
      const index = this.#distances.filter(from => distance >= from).length
      if (index === last && !isSteep && _place.dot(_direction) < COS_ASIDE * distance) continue
      const level = this.levels[index]
      level.setMatrixAt(level.count, matrix)
      level.setColorAt(level.count, color)
      level.count++
    }
    for (const level of this.levels) {
      level.visible = level.count > 0
      level.instanceMatrix.needsUpdate = true
      level.instanceColor!.needsUpdate = true
    }
    return true
  }

  override dispose(): void {
    disposeMeshes(this.levels)
  }
}
