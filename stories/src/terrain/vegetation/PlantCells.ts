import { groundSharesAt, type GroundShares, type Terrain } from '@welkin/terrain'
import type { Matrix4 } from 'three'
import { InstancedBufferAttribute, MathUtils, Vector3 } from 'three'
import { randomSequence } from '../../random'

/** Square of the ground that plants stand on. */
export interface GroundCell {
  /** Materials of the ground in its middle. */
  readonly shares: GroundShares
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

/** Cells about the viewer. */
export interface PlantCellsOptions {
  /** Side of a cell [m]. */
  readonly side: number
  /** Cells along an edge of their square, an even number. */
  readonly count: number
  /** Most plants in a cell. */
  readonly most: number
  /** Steps between known heights along a cell's edge. */
  readonly steps: number
  /** Plants a cell. */
  readonly sow: (cell: GroundCell) => void
}

const place = new Vector3()

/**
 * Plants in cells about a viewer: a cell that is left behind is planted anew on the other side, so that their number and memory stay. Of a
 * cell there is a grid of heights; a plant stands between them.
 */
export class PlantCells {
  /** Place and size of plants, and their turn about the vertical, two random numbers in [0, 1) and tint. */
  readonly places: InstancedBufferAttribute
  readonly looks: InstancedBufferAttribute
  readonly #options: PlantCellsOptions
  readonly #seed: number
  /** Column and row of the cell that each slot holds. */
  readonly #held: (readonly [number, number] | null)[]
  /** Cells about the viewer's, the nearest first. */
  readonly #order: (readonly [number, number])[]
  readonly #heights: number[] = []

  constructor(options: PlantCellsOptions, seed: number) {
    const { count, most } = options
    this.#options = options
    this.#seed = seed
    this.places = new InstancedBufferAttribute(new Float32Array(4 * count * count * most), 4)
    this.looks = new InstancedBufferAttribute(new Float32Array(4 * count * count * most), 4)
    this.#held = Array.from({ length: count * count }, () => null)
    const half = count / 2
    this.#order = this.#held
      .map((_, i) => [(i % count) - half, Math.floor(i / count) - half] as const)
      .sort(([a, b], [c, d]) => Math.hypot(a + 0.5, b + 0.5) - Math.hypot(c + 0.5, d + 0.5))
  }

  /** Forgets all plants: their frame has moved. */
  clear(): void {
    this.#held.fill(null)
    this.places.array.fill(0)
    this.places.needsUpdate = true
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
    const { side, count } = this.#options
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
    if (isChanged) this.places.needsUpdate = this.looks.needsUpdate = true
    return isChanged
  }

  #sow(terrain: Terrain, toWorld: Matrix4, u: number, v: number, slot: number): void {
    const { side, most, steps, sow } = this.#options
    const radius = terrain.atmosphere.ellipsoid.maximumRadius
    const heights = this.#heights
    for (let j = 0; j <= steps; j++) {
      for (let i = 0; i <= steps; i++) {
        const [x, z] = [(u + i / steps) * side, (v + j / steps) * side]
        const height = terrain.heightBelow(place.set(x, 0, z).applyMatrix4(toWorld))
        // The ground bends down from the plane.
        heights[j * (steps + 1) + i] = height - (x * x + z * z) / (2 * radius)
      }
    }
    place.set((u + 0.5) * side, 0, (v + 0.5) * side).applyMatrix4(toWorld)
    const shares = groundSharesAt(terrain, place)
    const random = randomSequence(this.#seed + Math.imul(u, 73856093) + Math.imul(v, 19349663))
    const [places, looks] = [this.places.array, this.looks.array]
    const first = 4 * slot * most
    places.fill(0, first, first + 4 * most)
    let n = 0
    const plant = (x: number, z: number, size: number, tint: number): void => {
      if (n === most) return
      const at = first + 4 * n++
      places.set([(u + x) * side, this.#heightAt(x, z), (v + z) * side, size], at)
      looks.set([2 * Math.PI * random(), random(), random(), tint], at)
    }
    sow({ shares, random, plant })
  }

  /** Height between those of the cell that is planted, places in [0, 1] [m]. */
  #heightAt(x: number, z: number): number {
    const { steps } = this.#options
    const [i, j] = [
      Math.min(Math.floor(x * steps), steps - 1),
      Math.min(Math.floor(z * steps), steps - 1)
    ]
    const [s, t] = [x * steps - i, z * steps - j]
    const at = (a: number, b: number): number => this.#heights[(j + b) * (steps + 1) + i + a]
    return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1))
  }
}
