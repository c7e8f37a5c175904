import {
  type BufferGeometry,
  Float32BufferAttribute,
  MathUtils,
  PlaneGeometry,
  Vector3
} from 'three'
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js'
import { randomSequence } from '../../random'
import { BARK, GOLDEN, LEAVES, trunk, type Color } from '../../valley/treeShapes'

/** Shape of a broad-leaved tree. */
interface Shape {
  /** Height of the tree and of the lowest leaves [m]. */
  readonly height: number
  readonly base: number
  /** Greatest radius of the crown, and its height as a part of the crown's [m, –]. */
  readonly radius: number
  readonly widest: number
  /** Radius of the leaves about a bough over the crown's, below and at the top. */
  readonly bough: readonly [below: number, above: number]
  /** Boughs, and sprays of leaves along the outer part of each. */
  readonly boughs: number
  readonly sprays: number
  readonly leaves: Color
  readonly bark: Color
  /** Radius of the trunk at its foot [m]; 0: neither it nor boughs are seen. */
  readonly trunk: number
}

/** A lime tree, broad and low; a slender birch, whose bark is white; an old oak that stands alone; a bush of a hedge. */
const SHAPES = {
  lime: {
    height: 9.3,
    base: 1.9,
    radius: 3.1,
    widest: 0.4,
    bough: [0.36, 0.26],
    boughs: 32,
    sprays: 11,
    leaves: LEAVES,
    bark: BARK,
    trunk: 0.3
  },
  birch: {
    height: 9.8,
    base: 2.3,
    radius: 1.75,
    widest: 0.32,
    bough: [0.36, 0.26],
    boughs: 26,
    sprays: 9,
    leaves: [0.076, 0.104, 0.029],
    bark: [0.2, 0.185, 0.165],
    trunk: 0.14
  },
  oak: {
    height: 17.5,
    base: 2.6,
    radius: 6.9,
    widest: 0.42,
    bough: [0.26, 0.2],
    boughs: 58,
    sprays: 11,
    leaves: [0.046, 0.073, 0.022],
    bark: BARK,
    trunk: 0.5
  },
  bush: {
    height: 2.9,
    base: 0.05,
    radius: 1.9,
    widest: 0.35,
    bough: [0.62, 0.46],
    boughs: 9,
    sprays: 5,
    leaves: [0.056, 0.084, 0.025],
    bark: BARK,
    trunk: 0
  }
} satisfies Record<string, Shape>

/** Part of the crown's radius out to which leaves are in the shade of others. */
const INNER = 0.4

/** Parts of a bough between which it has leaves. */
const LEAFY = [0.3, 1.06] as const

/** Height of the leaves about a bough over their width: each bough is a layer of its own. */
const FLATNESS = 0.62

/** Radius of the crown at a part of its height, over its greatest. */
const profile = (up: number, widest: number): number =>
  Math.sqrt(Math.max(1 - ((up - widest) / (up < widest ? widest * 1.1 : 1.04 - widest)) ** 2, 0.02))

/**
 * A broad-leaved tree: boughs about a trunk, all the way up, with leaves along them, darker within and below.
 *
 * @returns With colours, and texture coordinates for `setFoliage`.
 */
export function broadleaf(kind: keyof typeof SHAPES): BufferGeometry {
  const {
    height,
    base,
    radius,
    widest,
    bough: [below, above],
    boughs,
    sprays,
    leaves,
    bark,
    trunk: thickness
  }: Shape = SHAPES[kind]
  const random = randomSequence(29)
  const middle = new Vector3(0, MathUtils.lerp(base, height, 0.45), 0)
  const parts: BufferGeometry[] = thickness === 0 ? [] : [trunk(0.9 * height, thickness, bark, 6)]
  const [foot, tip, outwards, facing, vertex, inTree] = Array.from(
    { length: 6 },
    () => new Vector3()
  )
  const crownHeight = height - base
  for (let i = 0; i < boughs; i++) {
    const up = (i + 0.5 + 0.6 * (random() - 0.5)) / boughs
    const turn = GOLDEN * i + 0.7 * random()
    const reach = radius * profile(up, widest) * (0.62 + 0.3 * random()) * (1 - up ** 6)
    const size = radius * MathUtils.lerp(below, above, up) * (0.8 + 0.45 * random())
    tip.set(reach * Math.cos(turn), base + crownHeight * up, reach * Math.sin(turn))
    tip.y = Math.min(tip.y, height - 0.4 * size)
    // It rises from the trunk.
    foot.set(0, Math.max(tip.y - 0.9 * reach - 0.3, 0.75 * base), 0)
    if (thickness > 0) {
      const bough = tip.clone().sub(foot)
      const limb = trunk(bough.length(), thickness * MathUtils.lerp(0.36, 0.12, up), bark, 3)
      limb.rotateX(Math.acos(bough.y / bough.length())).rotateY(Math.atan2(bough.x, bough.z))
      parts.push(limb.translate(0, foot.y, 0))
    }
    for (let j = 0; j < sprays; j++) {
      const y = 1 - (2 * (j + 0.5)) / sprays
      const level = Math.sqrt(1 - y * y)
      const angle = GOLDEN * j + 6.3 * random()
      outwards.set(level * Math.cos(angle), y, level * Math.sin(angle))
      const edge = size * (1.15 + 0.5 * random())
      const spray = new PlaneGeometry(edge, edge).rotateZ(6.3 * random())
      facing
        .set(random() - 0.5, random() - 0.5, random() - 0.5)
        .multiplyScalar(1.9)
        .add(outwards)
      spray.lookAt(facing.normalize())
      // Shuffled, so that a spray's place along the bough does not follow its direction.
      const along = MathUtils.lerp(...LEAFY, Math.sqrt((((5 * j) % sprays) + random()) / sprays))
      const about = foot.clone().lerp(tip, along)
      const place = outwards.clone().multiplyScalar(0.6 * size)
      place.y *= FLATNESS
      place.add(about)
      spray.translate(place.x, place.y, place.z)
      const wide = radius * profile(MathUtils.clamp((place.y - base) / crownHeight, 0, 1), widest)
      const depth = MathUtils.smoothstep(Math.hypot(place.x, place.z) / wide, INNER, 1)
      const open = Math.max(depth, MathUtils.smoothstep(place.y, base + 0.55 * crownHeight, height))
      const shade = (0.38 + 0.62 * open) * (0.78 + 0.22 * y) * (0.82 + 0.36 * random())
      const { position, normal, uv } = spray.attributes
      const colors: number[] = []
      for (let k = 0; k < position.count; k++) {
        uv.setX(k, 0.5 * uv.getX(k))
        vertex.fromBufferAttribute(position, k)
        inTree.copy(vertex).sub(middle).normalize()
        vertex.sub(about).normalize().addScaledVector(inTree, 0.8).addScaledVector(facing, 0.25)
        vertex.normalize()
        normal.setXYZ(k, vertex.x, vertex.y, vertex.z)
        colors.push(...leaves.map(part => part * shade))
      }
      parts.push(spray.setAttribute('color', new Float32BufferAttribute(colors, 3)))
    }
  }
  return mergeGeometries(parts)
}
