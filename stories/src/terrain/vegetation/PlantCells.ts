import type { GroundShares, Terrain } from '@welkin/terrain'
import type { InstancedBufferGeometry, Matrix4, Plane } from 'three'
import { DynamicDrawUsage, InstancedBufferAttribute, MathUtils, Vector3 } from 'three'
import { randomSequence } from '../../random'
import type { CellGrounds } from './CellGrounds'

/** Square of the ground that plants stand on. */
export interface GroundCell {
  /** Materials of the ground in its middle. */
  readonly shares: GroundShares
  /** Height of its middle over the sea [m]. */
  readonly overSea: number
  /** Place of its corner in the plants' frame, and its side [m]. */
  readonly x: number
  readonly z: number
  readonly side: number
  /** Numbers in [0, 1), the same for the same cell. */
  readonly random: () => number
  /**
   * Plants one.
   *
   * @param x - Place in the cell, in [0, 1], like `z`.
   * @param size - Factor on its geometry.
   * @param tint - Any number that its material knows.
   */
  plant(x: number, z: number, size: number, tint: number): void
}

/** Part of the plants that is drawn at a distance: all up to `from`, `least` of them from `to` on [m]. */
export interface Thinning {
  readonly from: number
  readonly to: number
  readonly least: number
}

/** Cells about the viewer. */
export interface PlantCellsOptions {
  /** Ground of cells, whose side is that of these. */
  readonly grounds: CellGrounds
  /** Cells along an edge of their square, an even number. */
  readonly count: number
  /** Most plants in a cell. */
  readonly most: number
  /** Distances between which plants are drawn, and the height of the highest [m]. */
  readonly near: number
  readonly far: number
  readonly tall: number
  /** Null to draw all. */
  readonly thinning: Thinning | null
  /** Plants a cell. */
  readonly sow: (cell: GroundCell) => void
}

/** Least height over a lake's surface that plants grow at [m]. */
const DRY = 0.1

const place = new Vector3()

/** Part of the plants that is drawn at a distance [m]. */
const keptAt = (thinning: Thinning | null, distance: number): number =>
  thinning === null
    ? 1
    : MathUtils.clamp(
        MathUtils.mapLinear(distance, thinning.from, thinning.to, 1, thinning.least),
        thinning.least,
        1
      )

/**
 * Plants in cells about a viewer: a cell that is left behind is planted anew on the other side, so that their number and memory stay. Of a
 * cell there is a grid of heights; a plant stands between them. Plants of the cells in view are drawn, and no others.
 */
export class PlantCells {
  /** Place and size of the plants that are drawn; their turn about the vertical, a random number in [0, 1), their rank in the cell and tint. */
  readonly places: InstancedBufferAttribute
  readonly looks: InstancedBufferAttribute
  readonly options: PlantCellsOptions
  /** Plants of all cells, as many as `most` a slot. */
  readonly #places: Float32Array
  readonly #looks: Float32Array
  /** Number of plants in each slot, and height of its middle [m]. */
  readonly #counts: Uint16Array
  readonly #middles: Float32Array
  readonly #geometries: InstancedBufferGeometry[] = []
  readonly #seed: number
  /** Column and row of the cell that each slot holds. */
  readonly #held: (readonly [number, number] | null)[]
  /** Cells about the viewer's, the nearest first. */
  readonly #order: (readonly [number, number])[]
  /** Heights of the cell that is planted [m]. */
  #heights: Float32Array = new Float32Array()

  constructor(options: PlantCellsOptions, seed: number) {
    const { count, most } = options
    this.options = options
    this.#seed = seed
    const size = 4 * count * count * most
    this.#places = new Float32Array(size)
    this.#looks = new Float32Array(size)
    this.#counts = new Uint16Array(count * count)
    this.#middles = new Float32Array(count * count)
    this.places = new InstancedBufferAttribute(new Float32Array(size), 4)
    this.looks = new InstancedBufferAttribute(new Float32Array(size), 4)
    for (const values of [this.places, this.looks]) values.setUsage(DynamicDrawUsage)
    this.#held = Array.from({ length: count * count }, () => null)
    const half = count / 2
    this.#order = this.#held
      .map((_, i) => [(i % count) - half, Math.floor(i / count) - half] as const)
      .sort(([a, b], [c, d]) => Math.hypot(a + 0.5, b + 0.5) - Math.hypot(c + 0.5, d + 0.5))
  }

  /** Lets a geometry draw as many plants as are chosen. */
  add(geometry: InstancedBufferGeometry): void {
    geometry.setAttribute('plantPlace', this.places)
    geometry.setAttribute('plantLook', this.looks)
    geometry.instanceCount = 0
    this.#geometries.push(geometry)
  }

  /**
   * Chooses what is drawn: plants of the cells that are in view and neither too near nor too far.
   *
   * @param viewer - In the plants' frame, like `planes`, the sides of the view.
   */
  choose(viewer: Vector3, planes: readonly Plane[]): void {
    const { most, near, far, tall, thinning } = this.options
    const { side } = this.options.grounds
    const radius = side * Math.SQRT1_2 + tall
    let n = 0
    for (const [slot, count] of this.#counts.entries()) {
      const cell = this.#held[slot]
      if (count === 0 || cell === null) continue
      place.set((cell[0] + 0.5) * side, this.#middles[slot], (cell[1] + 0.5) * side)
      const distance = place.distanceTo(viewer)
      if (distance + radius < near || distance - radius > far) continue
      if (planes.some(plane => plane.distanceToPoint(place) < -radius)) continue
      const drawn = Math.min(count, Math.ceil(most * keptAt(thinning, distance - radius)))
      const first = 4 * slot * most
      const end = first + 4 * drawn
      ;(this.places.array as Float32Array).set(this.#places.subarray(first, end), 4 * n)
      ;(this.looks.array as Float32Array).set(this.#looks.subarray(first, end), 4 * n)
      n += drawn
    }
    for (const geometry of this.#geometries) geometry.instanceCount = n
    for (const values of [this.places, this.looks]) {
      values.clearUpdateRanges()
      values.addUpdateRange(0, 4 * n)
      values.needsUpdate = n > 0
    }
  }

  /** Visits all plants within a distance of a place, in view or not: `from` is the first of their four numbers. */
  visit(
    viewer: Vector3,
    reach: number,
    take: (places: Float32Array, looks: Float32Array, from: number) => void
  ): void {
    const { grounds, most } = this.options
    const { side } = grounds
    for (const [slot, count] of this.#counts.entries()) {
      const cell = this.#held[slot]
      if (count === 0 || cell === null) continue
      const [x, z] = [(cell[0] + 0.5) * side - viewer.x, (cell[1] + 0.5) * side - viewer.z]
      if (Math.hypot(x, z) > reach + side) continue
      for (let i = 0; i < count; i++) take(this.#places, this.#looks, 4 * (slot * most + i))
    }
  }

  /** Forgets all plants: their frame has moved. */
  clear(): void {
    this.#held.fill(null)
    this.#counts.fill(0)
    this.options.grounds.clear()
  }

  /**
   * Plants cells that the viewer has come near to, until the time is up.
   *
   * @param x - Place of the viewer in the plants' frame [m], like `z`.
   * @param toWorld - Matrix of that frame: a plane that touches the ellipsoid at its origin, y up.
   * @param until - As of `performance.now()`.
   * @returns True if any was planted.
   */
  update(terrain: Terrain, toWorld: Matrix4, x: number, z: number, until: number): boolean {
    const { count, grounds } = this.options
    const { side } = grounds
    const [column, row] = [Math.round(x / side), Math.round(z / side)]
    let isChanged = false
    for (const [i, j] of this.#order) {
      const [u, v] = [column + i, row + j]
      const slot = MathUtils.euclideanModulo(u, count) * count + MathUtils.euclideanModulo(v, count)
      const held = this.#held[slot]
      if (held?.[0] === u && held[1] === v) continue
      if (performance.now() > until) break
      this.#held[slot] = [u, v]
      this.#sow(terrain, toWorld, u, v, slot)
      isChanged = true
    }
    return isChanged
  }

  #sow(terrain: Terrain, toWorld: Matrix4, u: number, v: number, slot: number): void {
    const { grounds, most, sow } = this.options
    const { side } = grounds
    const ground = grounds.at(terrain, toWorld, u, v)
    const random = randomSequence(this.#seed + Math.imul(u, 73856093) + Math.imul(v, 19349663))
    const [places, looks] = [this.#places, this.#looks]
    const first = 4 * slot * most
    this.#middles[slot] = ground.middle
    let n = 0
    const plant = (x: number, z: number, size: number, tint: number): void => {
      if (n === most) return
      if (n === 0) this.#heights = grounds.heightsOf(ground, terrain, toWorld, u, v)
      const height = this.#heightAt(x, z)
      if (height < ground.water + DRY) return
      const at = first + 4 * n
      places.set([(u + x) * side, height, (v + z) * side, size], at)
      looks.set([2 * Math.PI * random(), random(), n / most, tint], at)
      n++
    }
    const overSea = ground.height - Math.max(terrain.seaLevel, -1e9)
    const { shares } = ground
    sow({ shares, overSea, x: u * side, z: v * side, side, random, plant })
    this.#counts[slot] = n
  }

  /** Height between those of the cell that is planted, places in [0, 1] [m]. */
  #heightAt(x: number, z: number): number {
    const { steps } = this.options.grounds
    const [i, j] = [
      Math.min(Math.floor(x * steps), steps - 1),
      Math.min(Math.floor(z * steps), steps - 1)
    ]
    const [s, t] = [x * steps - i, z * steps - j]
    const at = (a: number, b: number): number => this.#heights[(j + b) * (steps + 1) + i + a]
    return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1))
  }
}
