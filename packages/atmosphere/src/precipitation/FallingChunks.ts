import { Frustum, InstancedBufferAttribute, Matrix4, Vector3 } from 'three'
import type { Camera, Plane } from 'three'
import { drawnParticles, keptReach, type DrawnClass } from './cpu/drawnParticles'
import { diameterAt } from './cpu/sizes'
import type { FallingLattice } from './FallingLattice'
import type { ParticleKind } from './ParticleKind'

/** Cells along each edge of a class's box. */
export const CELLS = 8
/** Particles of a cell that fall together. */
export const CHUNK = 8
/** Strata of equal number into which a class's sizes are cut: particles of a chunk are of one, and fall equally fast. */
export const STRATA = 8
/** Chunks of a layer, which has one in each cell, and its particles. */
const LAYER_CHUNKS = CELLS ** 3
export const LAYER = CHUNK * LAYER_CHUNKS
/** Number of a chunk whose particles are never there. */
const NO_CHUNK = 2 ** 14 * LAYER_CHUNKS

const _middle = new Vector3()
const _drift = new Vector3()
const _frustum = new Frustum()
const _matrix = new Matrix4()

const fract = (x: number): number => x - Math.floor(x)

/**
 * Chunks of particles that a camera sees.
 *
 * Chunks over each other fall equally fast, so that they stay over each other, and particles as dense as they are. What is out
 * of view costs no vertices.
 */
export class FallingChunks {
  /** Per chunk: its number in its class; class and stratum, 8 c + s; distance fallen over its box's side; speed [m/s]. */
  readonly attribute: InstancedBufferAttribute
  #classes: readonly DrawnClass[] = []
  /** Speeds of columns, by class and layer [m/s]. */
  readonly #speeds: number[][]

  /** @param most - Most particles of a class. */
  constructor(
    private readonly kind: ParticleKind,
    private readonly most: number
  ) {
    const chunks = kind.reach.length * Math.ceil(most / LAYER) * LAYER_CHUNKS
    this.attribute = new InstancedBufferAttribute(new Float32Array(4 * chunks), 4)
    this.#speeds = kind.reach.map(() => [])
  }

  /** Sets the rate [mm/h]. @returns Classes as they are drawn. */
  setRate(rate: number): readonly DrawnClass[] {
    this.#classes = drawnParticles(this.kind, rate, this.most)
    return this.#classes
  }

  /** Speed of a column of chunks, whose number is 16 times its layer and its place in it [m/s]. */
  #speed(sizeClass: number, column: number): number {
    const { kind } = this
    return (this.#speeds[sizeClass][column] ??= kind.speed(
      diameterAt(
        kind.sizes(kind.drawnRate),
        kind.edges[sizeClass],
        kind.edges[sizeClass + 1],
        (stratumOf(column) + fract(column * 0.618034)) / STRATA
      )
    ))
  }

  /**
   * Finds the chunks that a camera sees.
   *
   * @param margin - Distance from its chunk up to which a particle is drawn [m].
   * @returns Number of chunks to draw.
   */
  update(lattice: FallingLattice, { projectionMatrix }: Camera, margin: number): number {
    _matrix.copy(lattice.toView).setPosition(0, 0, 0).premultiply(projectionMatrix)
    // The planes at the sides are the first four, whatever the depth is.
    const sides = _frustum.setFromProjectionMatrix(_matrix).planes.slice(0, 4)
    const { kind, attribute } = this
    const values = attribute.array
    let chunks = 0
    this.#classes.forEach(({ side, count }, sizeClass) => {
      const reach = kind.reach[sizeClass]
      const radius = (Math.sqrt(0.75) * side) / CELLS + margin
      lattice.box(reach, _middle, _drift)
      const { x: middleX, y: middleY, z: middleZ } = _middle
      /** Heights of middles of cells over the camera, by where they begin in the box. */
      const middleOf = (start: number): number => (start + 0.5 / CELLS - 0.5) * side
      const columns = Math.ceil(count / LAYER) * CELLS ** 2
      for (let column = 0; column < columns; column++) {
        // Of a layer far away, particles whose order in the class begins at a share are left out.
        const order = (Math.floor(column / CELLS ** 2) * LAYER) / count
        const farthest = reach * keptReach(kind.fullReach[sizeClass], order) + radius
        const intervals: number[] = []
        for (const x of images(fract((column % CELLS) / CELLS + _drift.x)))
          for (const z of images(fract((Math.floor(column / CELLS) % CELLS) / CELLS + _drift.z)))
            addInterval(
              intervals,
              sides,
              middleX + middleOf(x),
              middleZ + middleOf(z),
              radius,
              farthest
            )
        if (intervals.length === 0) continue
        const isSeen = (y: number): boolean => {
          const at = middleY + middleOf(y)
          for (let i = 0; i < intervals.length; i += 2)
            if (at > intervals[i] && at < intervals[i + 1]) return true
          return false
        }
        const speed = this.#speed(sizeClass, column)
        const fall = fract((speed * lattice.time) / side)
        const group = sizeClass * STRATA + stratumOf(column)
        for (let cell = 0; cell < CELLS; cell++) {
          const y = fract(cell / CELLS + _drift.y - fall)
          if (!isSeen(y) && !(y > 1 - 1 / CELLS && isSeen(y - 1))) continue
          const at = 4 * chunks++
          values[at] = column * CELLS + cell
          values[at + 1] = group
          values[at + 2] = fall
          values[at + 3] = speed
        }
      }
    })
    // Three draws one instance where there are none to draw.
    if (chunks === 0) attribute.setXYZW(0, NO_CHUNK, 0, 0, 0)
    attribute.clearUpdateRanges()
    attribute.addUpdateRange(0, 4 * Math.max(chunks, 1))
    attribute.needsUpdate = true
    return chunks
  }
}

/** Places at which a cell begins: one that reaches over its box's end goes on at the other. */
const images = (start: number): number[] => (start > 1 - 1 / CELLS ? [start, start - 1] : [start])

/**
 * Adds the stretch of a vertical line that is in view, two heights over the camera, if there is one.
 *
 * @param x - Place of the line from the camera [m].
 * @param radius - Distance from the view up to which counts as in it [m].
 * @param farthest - Distance from the camera [m].
 */
function addInterval(
  intervals: number[],
  sides: readonly Plane[],
  x: number,
  z: number,
  radius: number,
  farthest: number
): void {
  const square = farthest * farthest - x * x - z * z
  if (square <= 0) return
  let high = Math.sqrt(square)
  let low = -high
  for (const { normal, constant } of sides) {
    const least = -radius - constant - normal.x * x - normal.z * z
    if (normal.y > 0) low = Math.max(low, least / normal.y)
    else if (normal.y < 0) high = Math.min(high, least / normal.y)
    else if (least > 0) return
  }
  if (low < high) intervals.push(low, high)
}

/** Each stratum has as many columns of a layer as the others, and as many layers of a column. */
const stratumOf = (column: number): number =>
  (5 * (column % CELLS ** 2) + Math.floor(column / CELLS ** 2)) % STRATA
