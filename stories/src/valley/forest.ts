import {
  type BufferGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  Float32BufferAttribute,
  IcosahedronGeometry,
  Matrix4,
  Quaternion,
  Vector3
} from 'three'
import { mergeGeometries, mergeVertices } from 'three/addons/utils/BufferGeometryUtils.js'
import { randomSequence } from '../random'
import { fieldBorder, forestAt, groundHeight, isField, isOnRoad } from './ground'
import { VILLAGE } from './places'
import { smoothNoise } from './noise'
import { Trees, type Tree } from './Trees'

/** Distance from the village within which trees stand one by one [m]. */
const REACH = 2600

/** Distances from which trees are drawn with fewer triangles, and with the fewest [m]. */
const DISTANCES = [130, 420] as const

/** Number of the border between fields that is nearest to the village. */
const VILLAGE_BORDER = 6

/** Colours of needles, leaves and bark, linear sRGB. */
const NEEDLES = [0.03, 0.048, 0.02] as const
const LEAVES = [0.042, 0.07, 0.019] as const
const BARK = [0.06, 0.045, 0.032] as const

/**
 * Paints a part of a tree, darker where leaves shade each other: below.
 *
 * @param shade - Brightness at its foot over that at its top.
 */
function painted(
  geometry: BufferGeometry,
  [r, g, b]: readonly [number, number, number],
  shade = 1
): BufferGeometry {
  geometry.computeBoundingBox()
  const { min, max } = geometry.boundingBox!
  const { position } = geometry.attributes
  const colors = Array.from({ length: position.count }, (_, i) => {
    const height = (position.getY(i) - min.y) / (max.y - min.y)
    const brightness = shade + (1 - shade) * height
    return [r * brightness, g * brightness, b * brightness]
  }).flat()
  geometry.deleteAttribute('uv')
  return geometry.setAttribute('color', new Float32BufferAttribute(colors, 3))
}

/**
 * A spruce, 10 m high.
 *
 * @param tiers - Tiers of branches about the trunk.
 * @param sides - Sides of a tier.
 */
export function spruce(tiers: number, sides: number): BufferGeometry {
  const height = 9 / (tiers + 0.6)
  const cones = Array.from({ length: tiers }, (_, i) =>
    painted(
      new ConeGeometry(2.4 * (1 - i / (tiers + 0.4)), 1.8 * height, sides, 1, true)
        .translate(0, 0.9 + 0.9 * height + (i * (8.2 - height)) / tiers, 0)
        .rotateY(i),
      NEEDLES,
      0.55
    )
  )
  if (tiers === 1) return cones[0]
  const trunk = painted(new CylinderGeometry(0.12, 0.2, 2, 5, 1, true).translate(0, 0.8, 0), BARK)
  return mergeGeometries([...cones, trunk])
}

/**
 * A crown with an uneven outline, lit like a ball.
 *
 * @param detail - Times that its faces are divided.
 */
function leafy(x: number, y: number, z: number, size: number, detail: number): BufferGeometry {
  const crown = new IcosahedronGeometry(size, detail)
  const { position, normal } = crown.attributes
  const [vertex, leaf] = [new Vector3(), new Vector3()]
  const middle = new Vector3(x, y, z).sub(new Vector3(0, 4.8, 0))
  for (let i = 0; i < position.count; i++) {
    vertex.fromBufferAttribute(position, i)
    // Faces share places, not vertices.
    const [a, b, c] = vertex
      .clone()
      .multiplyScalar(7 / size)
      .round()
    const bump = Math.abs(Math.sin(12.9 * a + 78.2 * b + 37.7 * c + 10 * size) * 43_758.5) % 1
    vertex.multiplyScalar(0.72 + 0.46 * bump)
    position.setXYZ(i, vertex.x, vertex.y, vertex.z)
    // Half of the crown, half of the whole tree, with leaves turned this way and that.
    vertex.normalize().addScaledVector(middle, 0.25).normalize()
    vertex.addScaledVector(
      leaf.set(Math.sin(40 * bump), Math.sin(71 * bump), Math.sin(97 * bump)),
      0.3
    )
    vertex.normalize()
    normal.setXYZ(i, vertex.x, vertex.y, vertex.z)
  }
  // All that a vertex has follows from its place: faces share them.
  return mergeVertices(painted(crown.translate(x, y, z), LEAVES, 0.6))
}

/**
 * A broad-leaved tree, 9 m high.
 *
 * @param crowns - Balls of leaves, in [1, 5].
 * @param detail - Times that their faces are divided.
 */
export function limetree(crowns: number, detail: number): BufferGeometry {
  const balls =
    crowns === 1
      ? [leafy(0, 5.4, 0, 3.3, detail)]
      : [
          [0, 5.6, 0, 2.6],
          [1.5, 4.6, 0.6, 1.9],
          [-1.3, 4.9, 0.9, 1.8],
          [0.2, 4.4, -1.5, 1.9],
          [0.1, 7.3, 0.2, 1.7]
        ]
          .slice(0, crowns)
          .map(([x, y, z, size]) => leafy(x, y, z, size, detail))
  const trunk = new CylinderGeometry(0.2, 0.32, 3.4, 5, 1, true)
  return mergeGeometries([...balls, painted(trunk.translate(0, 1.6, 0), BARK)])
}

/** Spruces on the slopes. */
export const createForest = (count: number): Trees =>
  new Trees(
    [spruce(5, 8), spruce(3, 5), spruce(1, 4)],
    DISTANCES,
    plant(count, 11, (x, z, height) => forestAt(x, z) + (height > 2 ? 0.004 : 0))
  )

/** Broad-leaved trees about the village, along the shore, in hedges and copses. */
export function createGrove(count: number): Trees {
  const hedges = hedgesNear(0.25 * count)
  const others = plant(count - hedges.length, 23, (x, z, height) => {
    const fromVillage = Math.hypot(x - VILLAGE.x, z - VILLAGE.z)
    const shore = height > 1.2 && height < 5 ? 0.35 : 0
    const village = fromVillage > 30 && fromVillage < 210 ? 0.22 : 0
    // Few stand alone.
    const copse = smoothNoise(x / 45, z / 45) > 0.32 ? 0.16 : 0.006
    return height > 1.2 && height < 45 ? shore + village + copse : 0
  })
  return new Trees(
    [limetree(5, 2), limetree(5, 0), limetree(1, 0)],
    DISTANCES,
    hedges.concat(others)
  )
}

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
      if (isRow && isField(x, z) && !isOnRoad(x, z, 3)) trees.push(treeAt(x, z, 0.62, random))
    }
  }
  return trees
}

/** @param shareAt - Chance of a tree at a place of a height, in [0, 1]. */
function plant(
  count: number,
  seed: number,
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
    if (random() < shareAt(x, z, groundHeight(x, z))) trees.push(treeAt(x, z, 1, random))
  }
  return trees
}

/**
 * A tree of some size, shape and hue.
 *
 * @param scale - Size over that of trees that stand by themselves.
 */
function treeAt(x: number, z: number, scale: number, random: () => number): Tree {
  const size = scale * (0.55 + 0.95 * random() ** 1.5)
  // From broad ones to slender ones.
  const slender = 1.3 ** (2 * random() - 1)
  const matrix = new Matrix4().compose(
    new Vector3(x, groundHeight(x, z) - 0.2, z),
    new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), 6.3 * random()),
    new Vector3(
      (size * (0.85 + 0.3 * random())) / slender,
      size * slender * (0.9 + 0.35 * random()),
      size / slender
    )
  )
  // Some are yellower, some nearly blue.
  const [brightness, yellow] = [0.75 + 0.55 * random(), random() ** 1.5]
  const color = new Color(0.85 + 0.75 * yellow, 0.95 + 0.25 * yellow, 1.1 - 0.4 * yellow)
  return { matrix, color: color.multiplyScalar(brightness) }
}
