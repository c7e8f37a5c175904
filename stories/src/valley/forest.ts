import { Color, Matrix4, Quaternion, Vector3 } from 'three'
import type { SurfaceWater } from '@welkin/atmosphere'
import { randomSequence } from '../random'
import { fieldBorder, forestAt, groundHeight, isField, isOnRoad } from './ground'
import { VILLAGE } from './places'
import { smoothNoise } from './noise'
import { branchedSpruce, distantTree, leafyTree, spruce } from './treeShapes'
import { Trees, type Tree } from './Trees'

/** Distance from the village within which trees stand one by one [m]. */
const REACH = 2600

/** Distances from which trees are drawn with fewer triangles, and with the fewest [m]. */
const DISTANCES = [130, 420] as const

/** Rain and snow on trees; null where none falls. */
type Water = SurfaceWater | null

const winterOf = (water: Water, isBare: boolean) => water && { water, isBare }

/** Chance of a tree that stands alone. Greater: from afar meadows are dotted (*Valley, all day*). */
const LONE = 0.0024

/** Height of broad-leaved trees of size 1 [m]. */
const HEIGHT = 9

/**
 * Greatest parts of trees' heights that are below the ground. Crowns of hedges begin there, those of trees in the open not far
 * above: with trunks of one length, trees look like lollipops (*Valley, all day*).
 */
const SUNK = { hedge: 0.22, open: 0.16, wood: 0 } as const

/** Number of the border between fields that is nearest to the village. */
const VILLAGE_BORDER = 6

/** Spruces on the slopes. */
export const createForest = (count: number, water: Water = null): Trees =>
  new Trees(
    [branchedSpruce(9, 6), spruce(5, 8), spruce(1, 4)],
    DISTANCES,
    plant(count, 11, SUNK.wood, (x, z, height) => forestAt(x, z) + (height > 2 ? LONE / 2 : 0)),
    1,
    winterOf(water, false)
  )

/** Broad-leaved trees about the village, along the shore, in hedges and copses. */
export function createGrove(count: number, water: Water = null): Trees {
  const hedges = hedgesNear(0.25 * count)
  const others = plant(count - hedges.length, 23, SUNK.open, (x, z, height) => {
    const fromVillage = Math.hypot(x - VILLAGE.x, z - VILLAGE.z)
    const shore = height > 1.2 && height < 5 ? 0.35 : 0
    const village = fromVillage > 30 && fromVillage < 210 ? 0.34 : 0
    // Few stand alone.
    const copse = smoothNoise(x / 45, z / 45) > 0.3 ? 0.2 : LONE
    return height > 1.2 && height < 45 ? shore + village + copse : 0
  })
  return new Trees(
    [leafyTree('lime', 11), leafyTree('lime', 3), distantTree('lime', 2)],
    DISTANCES,
    hedges.concat(others),
    2,
    winterOf(water, true)
  )
}

/** Birches among them. */
export const createBirches = (count: number, water: Water = null): Trees =>
  new Trees(
    [leafyTree('birch', 10), leafyTree('birch', 3), distantTree('birch', 2)],
    DISTANCES,
    plant(count, 37, SUNK.open, (x, z, height) => {
      const copse = smoothNoise(x / 60 + 40, z / 60) > 0.36 ? 0.2 : LONE
      const shore = height > 1.2 && height < 4 ? 0.2 : 0
      return height > 1.2 && height < 120 ? shore + copse : 0
    }),
    2,
    winterOf(water, true)
  )

/** Trees in rows between fields, from the village outwards; rows have gaps. */
function hedgesNear(count: number): Tree[] {
  const random = randomSequence(31)
  const trees: Tree[] = []
  for (let i = 0; trees.length < count && i < 40; i++) {
    const border = VILLAGE_BORDER + (i % 2 === 0 ? i / 2 : -(i + 1) / 2)
    for (let along = -520; along < 700 && trees.length < count; along += 5 + 5 * random()) {
      const z = VILLAGE.z + along
      const x = fieldBorder(border, z) + 1.5 * random()
      const isRow = smoothNoise(0.37 * border, z / 130) > 0.12
      if (isRow && isField(x, z) && !isOnRoad(x, z, 3))
        trees.push(treeAt(x, z, 0.62, random, SUNK.hedge))
    }
  }
  return trees
}

/**
 * Trees at places by chance.
 *
 * @param sunk - Greatest part of their heights that is below the ground.
 * @param shareAt - Chance of a tree at a place of a height, in [0, 1].
 */
function plant(
  count: number,
  seed: number,
  sunk: number,
  shareAt: (x: number, z: number, height: number) => number
): Tree[] {
  const random = randomSequence(seed)
  const trees: Tree[] = []
  for (let tries = 0; trees.length < count && tries < 60 * count; tries++) {
    const angle = 2 * Math.PI * random()
    const distance = REACH * random() ** 0.8 + 14
    const x = VILLAGE.x + distance * Math.cos(angle)
    const z = VILLAGE.z + distance * Math.sin(angle)
    if (isOnRoad(x, z, 3)) continue
    if (random() < shareAt(x, z, groundHeight(x, z))) trees.push(treeAt(x, z, 1, random, sunk))
  }
  return trees
}

/**
 * A tree of some size, shape and hue.
 *
 * @param scale - Size over that of trees that stand by themselves.
 * @param sunk - Greatest part of its height that is below the ground.
 */
function treeAt(x: number, z: number, scale: number, random: () => number, sunk: number): Tree {
  const size = scale * (0.55 + 0.95 * random() ** 1.5)
  // From broad ones to slender ones.
  const slender = 1.3 ** (2 * random() - 1)
  const turn = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), 6.3 * random())
  const shape = new Vector3(
    (size * (0.85 + 0.3 * random())) / slender,
    size * slender * (0.9 + 0.35 * random()),
    size / slender
  )
  // As random as the place.
  const chance = x - Math.floor(x)
  const depth = sunk * (0.3 + 0.7 * chance) * HEIGHT * shape.y
  const matrix = new Matrix4().compose(
    new Vector3(x, groundHeight(x, z) - 0.2 - depth, z),
    turn,
    shape
  )
  // Some are yellower, some nearly blue.
  const [brightness, yellow] = [0.75 + 0.55 * random(), random() ** 1.5]
  const color = new Color(0.85 + 0.75 * yellow, 0.95 + 0.25 * yellow, 1.1 - 0.4 * yellow)
  return { matrix, color: color.multiplyScalar(brightness) }
}
