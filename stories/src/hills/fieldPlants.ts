import { MathUtils } from 'three'
import { randomSequence } from '../random'
import { hashed, valueNoise } from '../terrain/vegetation/valueNoise'
import { FIELD, isWood, placeInFields, SHIFT } from './fieldPlan'

/** A plant on the ground of the plain. */
export interface Plant {
  readonly x: number
  readonly z: number
  /** Factor on its shape. */
  readonly size: number
  /** Brightness over that of its shape. */
  readonly tint: number
}

/** Range of sizes of each kind. */
const SIZES = {
  oak: [0.55, 1.15],
  lime: [1, 1.85],
  birch: [0.9, 1.65],
  spruce: [1, 2.1],
  bush: [0.6, 1.15]
} as const

export type PlantKind = keyof typeof SIZES
export const PLANT_KINDS = Object.keys(SIZES) as PlantKind[]

/** Columns and rows of fields on either side of the origin. */
const COLUMNS = 50
const ROWS = 23

/** Length of a piece of hedge [m], bushes in it, and distances up to which there are so many [m]. */
const PIECE = 9
const BUSHES = [8, 4, 3] as const
const HEDGES_TO = [120, 380, 1500] as const

/** Distances from the origin between which trees stand, and beyond which there are fewer in hedges [m]. */
const TREES_FROM = 55
const TREES_TO = 4600
const FEWER_FROM = 1200

/** Share of edges of fields that have a hedge, and trees of a piece of it where they stand close. */
const HEDGED = 0.75
const TREES = 0.55

/** Distances between trees at the edge of a wood and within [m]. */
const AT_EDGE = 4.5
const WITHIN = 13

/** Hedges, trees in them, and woods of the plain, the same on every run. */
export function fieldPlants(): Record<PlantKind, Plant[]> {
  const random = randomSequence(11)
  const plants = Object.fromEntries(PLANT_KINDS.map(kind => [kind, [] as Plant[]])) as Record<
    PlantKind,
    Plant[]
  >
  const add = (kind: PlantKind, x: number, z: number, age: number): void => {
    const [least, most] = SIZES[kind]
    const size = MathUtils.lerp(least, most, age)
    plants[kind].push({ x, z, size, tint: 1.3 + 0.9 * random() })
  }

  /** A piece of the edge of a field, from one place in the fields to another. */
  const addPiece = (
    edge: number,
    from: readonly [number, number],
    to: readonly [number, number]
  ): void => {
    const [x, z] = placeInFields(...from)
    const distance = Math.hypot(x, z)
    const [endX, endZ] = placeInFields(...to)
    const isOpen = edge > HEDGED || valueNoise(x / 30, z / 30, 60) < 0.14
    const ring = HEDGES_TO.findIndex(reach => distance < reach)
    const count = isOpen || ring < 0 ? 0 : BUSHES[ring]
    for (let i = 0; i < count; i++) {
      const along = (i + random()) / count
      const aside = 1.1 * (random() - 0.5)
      const high = 0.3 + 0.5 * edge + 0.7 * (random() - 0.4)
      add(
        'bush',
        MathUtils.lerp(x, endX, along) + aside,
        MathUtils.lerp(z, endZ, along) - aside,
        high + 0.2 * ring
      )
    }
    // They stand in groups, also where there is no hedge.
    const close = MathUtils.smoothstep(valueNoise(x / 90, z / 90, 61), 0.35, 0.85)
    const share = TREES * close * Math.min(FEWER_FROM / distance, 1) * (edge > HEDGED ? 0.4 : 1)
    if (random() > share || distance < TREES_FROM) return
    const chance = random()
    const kind = chance < 0.45 ? 'oak' : chance < 0.75 ? 'lime' : 'birch'
    add(kind, x + 2 * random() - 1, z + 2 * random() - 1, random())
  }

  /** Trees of a field that is a wood: close along its edges, wide apart within, where one sees their tops alone. */
  const addWood = (column: number, row: number, start: number): void => {
    const isDark = hashed(column, row, 72) < 0.35
    const addTree = (across: number, along: number): void => {
      const [x, z] = placeInFields(column + across, start + along)
      const chance = random()
      const leafy = chance < 0.5 ? 'oak' : chance < 0.8 ? 'lime' : 'birch'
      add(isDark && chance < 0.85 ? 'spruce' : leafy, x, z, 0.3 + 0.7 * random())
    }
    const [wide, long] = FIELD.map(side => Math.round(side / AT_EDGE))
    for (let i = 0; i < wide; i++) {
      for (const end of [0.01, 0.99]) addTree((i + random()) / wide, end)
    }
    for (let i = 0; i < long; i++) {
      for (const side of [0.02, 0.98]) addTree(side, (i + random()) / long)
    }
    const [columns, rows] = FIELD.map(side => Math.round(side / WITHIN))
    for (let i = 0; i < columns * rows; i++) {
      addTree(((i % columns) + random()) / columns, (Math.floor(i / columns) + random()) / rows)
    }
  }

  const pieces = FIELD.map(side => Math.round(side / PIECE))
  for (let column = -COLUMNS; column <= COLUMNS; column++) {
    for (let i = -ROWS; i <= ROWS; i++) {
      const row = i + Math.round(SHIFT * column)
      const start = row - SHIFT * column
      const [middleX, middleZ] = placeInFields(column + 0.5, start + 0.5)
      if (Math.hypot(middleX, middleZ) > TREES_TO) continue
      if (isWood(column, row)) addWood(column, row, start)
      const [side, end] = [hashed(column, row, 70), hashed(column, row, 71)]
      for (let j = 0; j < pieces[1]; j++) {
        const [from, to] = [start + j / pieces[1], start + (j + 1) / pieces[1]]
        addPiece(side, [column, from], [column, to])
      }
      for (let j = 0; j < pieces[0]; j++) {
        const [from, to] = [column + j / pieces[0], column + (j + 1) / pieces[0]]
        addPiece(end, [from, start], [to, start])
      }
    }
  }
  return plants
}
