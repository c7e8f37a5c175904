import { Color, DoubleSide, Group, InstancedMesh, Vector3 } from 'three'
import type { BufferGeometry, Matrix4, PerspectiveCamera } from 'three'
import {
  attribute,
  normalView,
  positionGeometry,
  positionViewDirection,
  sin,
  smoothstep,
  vec3
} from 'three/tsl'
import type { Node } from 'three/webgpu'
import { disposeMeshes } from '../scene'
import { VertexLitMaterial } from './VertexLitMaterial'

/** A tree: its place and size, and its brightness over that of its kind. */
export interface Tree {
  readonly matrix: Matrix4
  readonly color: Color
}

/** Distance that the camera moves, and cosine of its turn, before trees are sorted by distance anew [m]. */
const STEP = 10
const COS_TURN = Math.cos(0.3)

/**
 * Cosine of the angle from the direction of view beyond which trees of the last level are left out: the picture's corners
 * are 51° from it. Of a view that is steeper than this sine, none are.
 */
const COS_ASIDE = Math.cos(1.3)
const STEEP = 0.6

const _place = new Vector3()
const _direction = new Vector3()

/** Leaves and the gaps between them, of trees of either kind. */
interface Foliage {
  /** Brightness, about 1. */
  readonly brightness: Node<'float'>
  /** False in gaps between leaves, which are many where one looks along the leaves of a crown: at its edge. */
  readonly isSolid: Node<'bool'>
}

/** Foliage as noise in space; bark, of which vertices are redder than green, has no gaps. */
export function foliage(): Foliage {
  // Waves that bend each other: products of straight ones show as a net.
  const bend = (by: Node<'vec3'>, scale: number, strength: number): Node<'vec3'> =>
    positionGeometry.mul(scale).add(sin(by).mul(strength)).toConst()
  const branches = bend(positionGeometry.zxy.mul(2.3), 3.1, 1.9)
  const leaves = bend(branches.yzx.mul(1.7), 11, 2.4)
  const coarse = sin(branches.x).mul(sin(branches.y.add(branches.z)))
  const fine = sin(leaves.x.add(leaves.y)).mul(sin(leaves.z.sub(leaves.y.mul(0.6))))
  const brightness = smoothstep(-1.1, 1.1, coarse.mul(0.7).add(fine.mul(0.8)))
    .mul(0.7)
    .add(0.65)
  const density = coarse.add(fine).mul(0.25).add(0.5)
  const facing = normalView.dot(positionViewDirection).abs()
  const [bark, green] = [attribute<'vec3'>('color', 'vec3').r, attribute<'vec3'>('color', 'vec3').g]
  const hasLeaf = density.greaterThan(smoothstep(0.75, 0.05, facing).mul(0.68))
  return { brightness, isSolid: hasLeaf.or(bark.greaterThan(green)) }
}

/** Trees of a kind, drawn with fewer triangles the farther they are from the camera. */
export class Trees extends Group {
  readonly #trees: readonly Tree[]
  readonly #distances: readonly number[]
  /** Levels of detail, the finest first. */
  readonly levels: readonly InstancedMesh[]
  readonly #sortedAt = new Vector3(Infinity, 0, 0)
  readonly #sortedTowards = new Vector3()

  /**
   * @param geometries - Finest to coarsest, with vertex colours.
   * @param distances - Distances from which each but the first is drawn [m].
   */
  constructor(
    geometries: readonly BufferGeometry[],
    distances: readonly number[],
    trees: readonly Tree[]
  ) {
    super()
    this.#trees = trees
    this.#distances = distances
    const { brightness, isSolid } = foliage()
    const [near, far] = [0, 1].map(() => {
      const material = new VertexLitMaterial({ side: DoubleSide, vertexColors: true })
      material.colorNode = vec3(brightness)
      return material
    })
    // Gaps are smaller than pixels elsewhere.
    near.maskNode = isSolid
    this.levels = geometries.map((geometry, level) => {
      const mesh = new InstancedMesh(geometry, level === 0 ? near : far, trees.length)
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
    for (const { matrix, color } of this.#trees) {
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
