import { groundSharesAt, type GroundShares, type GroundWater, type Terrain } from '@welkin/terrain'
import { Vector3, type Matrix4 } from 'three'

/** Ground of a cell. */
export interface CellGround {
  /** Height of its middle over the ellipsoid, and over the plane of the plants' frame [m]. */
  readonly height: number
  readonly middle: number
  /** Surface of a lake over that plane; −Infinity where there is none [m]. */
  readonly water: number
  /** Materials of the ground in its middle. */
  readonly shares: GroundShares
  /** Heights over the frame's plane, rows of `steps` + 1; null before any is needed [m]. */
  heights: Float32Array | null
}

const place = new Vector3()
const subpoint = new Vector3()

/** Ground of square cells, found once for all plants that stand on them. */
export class CellGrounds {
  readonly #known = new Map<string, CellGround>()

  /**
   * @param side - Side of a cell [m].
   * @param steps - Steps between known heights along it.
   * @param most - Cells that are remembered.
   */
  constructor(
    readonly side: number,
    readonly steps: number,
    readonly most: number
  ) {}

  /** Forgets all: the plants' frame has moved. */
  clear(): void {
    this.#known.clear()
  }

  /** Ground of the cell in a column and row. @param toWorld - Matrix of the plants' frame. */
  at(terrain: Terrain, toWorld: Matrix4, u: number, v: number): CellGround {
    const key = `${u} ${v}`
    const known = this.#known.get(key)
    if (known !== undefined) return known
    if (this.#known.size >= this.most) this.#known.clear()
    const [x, z] = [(u + 0.5) * this.side, (v + 0.5) * this.side]
    place.set(x, 0, z).applyMatrix4(toWorld)
    const height = terrain.heightBelow(place)
    const lake = lakeAt(terrain, place)
    const ground: CellGround = {
      height,
      middle: height - bend(terrain, x, z),
      water: (lake?.level ?? -Infinity) - bend(terrain, x, z),
      shares: groundSharesAt(terrain, place),
      heights: null
    }
    this.#known.set(key, ground)
    return ground
  }

  /** Heights of a cell, found at the first call: bare cells need none. */
  heightsOf(
    ground: CellGround,
    terrain: Terrain,
    toWorld: Matrix4,
    u: number,
    v: number
  ): Float32Array {
    if (ground.heights !== null) return ground.heights
    const { side, steps } = this
    const heights = (ground.heights = new Float32Array((steps + 1) ** 2))
    for (let j = 0; j <= steps; j++) {
      for (let i = 0; i <= steps; i++) {
        const [x, z] = [(u + i / steps) * side, (v + j / steps) * side]
        const height = terrain.heightBelow(place.set(x, 0, z).applyMatrix4(toWorld))
        heights[j * (steps + 1) + i] = height - bend(terrain, x, z)
      }
    }
    return heights
  }
}

/** Lake whose circle a point of the world is in. */
function lakeAt({ atmosphere, lakes }: Terrain, position: Vector3): GroundWater | undefined {
  if (lakes.length === 0) return undefined
  const { ellipsoid, worldToECEF } = atmosphere
  ellipsoid.footPoint(subpoint.copy(position).applyMatrix4(worldToECEF), subpoint)
  return lakes.find(lake => lake.covers(subpoint))
}

/** Height by which the ground bends down from the plane of the plants' frame [m]. */
const bend = ({ atmosphere }: Terrain, x: number, z: number): number =>
  (x * x + z * z) / (2 * atmosphere.ellipsoid.maximumRadius)
