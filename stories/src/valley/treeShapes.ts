import {
  type BufferGeometry,
  ConeGeometry,
  CylinderGeometry,
  Float32BufferAttribute,
  IcosahedronGeometry,
  PlaneGeometry,
  Vector3
} from 'three'
import { mergeGeometries, mergeVertices } from 'three/addons/utils/BufferGeometryUtils.js'
import { randomSequence } from '../random'

/** Colour, linear sRGB. */
export type Color = readonly [number, number, number]

/** Colours of needles, leaves and bark. */
const NEEDLES = [0.03, 0.048, 0.02] as const
export const LEAVES = [0.055, 0.084, 0.027] as const
export const BARK = [0.056, 0.048, 0.04] as const

/** Needles and leaves in the shade of a crown: with next to no blue, by which they have no gaps. */
const SHADE = [0.022, 0.0356, 0.0002] as const
const LEAVES_SHADE = [0.036, 0.058, 0.002] as const

/** Golden angle, by which branches turn about a trunk [rad]. */
export const GOLDEN = 2.4

/**
 * Paints a part of a tree, darker where leaves shade each other: below.
 *
 * @param shade - Brightness at its foot over that at its top.
 */
export function painted(geometry: BufferGeometry, [r, g, b]: Color, shade = 1): BufferGeometry {
  geometry.computeBoundingBox()
  const { min, max } = geometry.boundingBox!
  const { position } = geometry.attributes
  const colors = Array.from({ length: position.count }, (_, i) => {
    const height = (position.getY(i) - min.y) / Math.max(max.y - min.y, 1e-6)
    const brightness = shade + (1 - shade) * height
    return [r * brightness, g * brightness, b * brightness]
  }).flat()
  return geometry.setAttribute('color', new Float32BufferAttribute(colors, 3))
}

/** A ball of few faces, lit as round, with a spray of leaves for its picture. */
export function ball(size: number): BufferGeometry {
  const faces = new IcosahedronGeometry(size, 0)
  faces.deleteAttribute('uv')
  faces.deleteAttribute('normal')
  const round = mergeVertices(faces)
  const { position } = round.attributes
  const normals = Float32Array.from(position.array, value => value / size)
  round.setAttribute('normal', new Float32BufferAttribute(normals, 3))
  const places = Array.from({ length: position.count }, (_, i) => [
    0.25 + (0.2 * position.getX(i)) / size,
    0.5 + (0.4 * position.getY(i)) / size
  ])
  return round.setAttribute('uv', new Float32BufferAttribute(places.flat(), 2))
}

/** Radius of a clump's dark middle over that of the clump: a larger one shows through its leaves as a ball. */
const CORE = 0.36

/** Sprays of a clump below which trees are seen from afar: they have no twigs. */
const FEW = 8

/** A trunk up to a height, of some radius at its foot [m]. */
export const trunk = (
  height: number,
  radius: number,
  color: Color = BARK,
  sides = 5
): BufferGeometry =>
  painted(
    new CylinderGeometry(0.25 * radius, radius, height, sides, 1, true).translate(0, height / 2, 0),
    color
  )

/**
 * A branch of a spruce: a twig of needles, bent down on both sides like a roof.
 *
 * @param height - Height of its root [m].
 * @param turn - About the trunk [rad].
 * @param brightness - Over that of needles in the light.
 */
function needleBranch(
  height: number,
  length: number,
  turn: number,
  brightness: number
): BufferGeometry {
  const branch = new PlaneGeometry(1.05 * length, length, 2, 1)
  const { position, normal, uv } = branch.attributes
  const side = new Vector3()
  const colors: number[] = []
  for (let i = 0; i < position.count; i++) {
    const across = position.getX(i)
    const along = position.getY(i) + length / 2
    uv.setXY(i, 0.5 + 0.5 * uv.getX(i), uv.getY(i))
    // It leaves the trunk nearly level and hangs; its tip rises a little.
    position.setXYZ(i, across, -0.5 * along - 0.5 * Math.abs(across), along * 0.9)
    side.set(across / length, 0.75, 0.35 + 0.5 * (along / length)).normalize()
    normal.setXYZ(i, side.x, side.y, side.z)
    const shade = brightness * (along > 0 ? 1.1 : 0.4)
    colors.push(...NEEDLES.map(part => part * shade))
  }
  branch.setAttribute('color', new Float32BufferAttribute(colors, 3))
  return branch.rotateY(turn).translate(0, height, 0)
}

/** A spruce of whorls of branches with gaps between them, 10 m high. @param whorls - Number of whorls. */
export function branchedSpruce(whorls: number, branches: number): BufferGeometry {
  const random = randomSequence(17)
  const parts = Array.from({ length: whorls * branches }, (_, i) => {
    const up = (Math.floor(i / branches) + 0.7 * random()) / whorls
    const length = (2.75 * (1 - up) ** 0.85 + 0.4) * (0.8 + 0.35 * random())
    const turn = GOLDEN * i + 0.5 * random()
    return needleBranch(1.2 + 8.7 * up, length, turn, 0.55 + 0.5 * up)
  })
  const core = new ConeGeometry(0.5, 8, 5, 1, true).translate(0, 5.2, 0)
  core.attributes.uv.array.fill(0) // it has no picture
  return mergeGeometries([...parts, painted(core, SHADE), trunk(9.6, 0.2)])
}

/**
 * A spruce of cones, 10 m high, for the distance: of more than one, with rims between branches drawn in.
 *
 * @param tiers - Tiers of branches about the trunk.
 * @param sides - Sides of a tier.
 */
export function spruce(tiers: number, sides: number): BufferGeometry {
  const height = 9 / (tiers + 0.6)
  const cones = Array.from({ length: tiers }, (_, i) => {
    const cone = new ConeGeometry(
      (tiers > 1 ? 2.5 : 2) * (1 - i / (tiers + 0.4)),
      1.8 * height,
      sides,
      1,
      true
    )
    const { position } = cone.attributes
    for (let j = sides + 1; tiers > 1 && j < position.count; j++) {
      if (j % 2 === 0) continue
      position.setXYZ(j, 0.62 * position.getX(j), 0.45 * position.getY(j), 0.62 * position.getZ(j))
    }
    cone.translate(0, 0.9 + 0.9 * height + (i * (8.2 - height)) / tiers, 0)
    return painted(cone.rotateY(i), NEEDLES, 0.55)
  })
  return tiers === 1 ? cones[0] : mergeGeometries(cones)
}

/** Shape of the crown of a broad-leaved tree. */
interface Crown {
  /** Clumps of leaves: middle and radius [m]. */
  readonly clumps: readonly (readonly [x: number, y: number, z: number, size: number])[]
  readonly leaves: Color
  readonly bark: Color
  /** Radius of the trunk at its foot [m]. */
  readonly trunk: number
}

/** A lime tree, and a birch, whose bark is white, 9 m high. */
export const CROWNS = {
  lime: {
    clumps: [
      [0, 5.6, 0, 2],
      [2.1, 4.5, 0.6, 1.5],
      [-2, 4.9, 1.1, 1.4],
      [0.4, 4, -2.2, 1.45],
      [-1.3, 7, -1.2, 1.3],
      [1.1, 7.7, 0.5, 1.25],
      [-0.7, 3.3, 1.9, 1]
    ],
    leaves: LEAVES,
    bark: BARK,
    trunk: 0.3
  },
  birch: {
    clumps: [
      [0, 7.6, 0, 1],
      [0.5, 6.4, 0.3, 1.25],
      [-0.7, 5.4, 0.4, 1.2],
      [0.6, 4.5, -0.6, 1.25],
      [-0.4, 3.6, -0.5, 1.1]
    ],
    leaves: [0.076, 0.104, 0.029],
    bark: [0.2, 0.185, 0.165],
    trunk: 0.14
  }
} satisfies Record<string, Crown>

/**
 * A clump: sprays of leaves that look this way and that about a dark middle, lit like a ball.
 *
 * @param sprays - Number of sprays.
 */
function clump(
  [x, y, z, size]: readonly [number, number, number, number],
  sprays: number,
  leaves: Color,
  random: () => number
): BufferGeometry[] {
  const middle = new Vector3(x, y, z)
  const [outwards, normalOf, vertex] = [new Vector3(), new Vector3(), new Vector3()]
  const parts = Array.from({ length: sprays }, (_, i) => {
    const height = 1 - (2 * (i + 0.5)) / sprays
    const radius = Math.sqrt(1 - height * height)
    const turn = GOLDEN * i + random()
    outwards.set(radius * Math.cos(turn), height, radius * Math.sin(turn))
    const edge = size * (1.15 + 0.35 * random()) * (sprays < FEW ? 1.75 : 1.05)
    const spray = new PlaneGeometry(edge, edge).rotateZ(6.3 * random())
    // Half of them face outwards, the others stand on the crown.
    normalOf
      .set(random() - 0.5, random() - 0.5, random() - 0.5)
      .multiplyScalar(2.2)
      .add(outwards)
    const place = outwards
      .clone()
      .multiplyScalar(0.72 * size)
      .add(middle)
    spray.lookAt(normalOf.normalize())
    spray.translate(place.x, place.y, place.z)
    const { position, normal, uv } = spray.attributes
    const shade = (0.62 + 0.38 * ((outwards.y + 1) / 2)) * (0.85 + 0.3 * random())
    const colors: number[] = []
    for (let j = 0; j < position.count; j++) {
      uv.setX(j, 0.5 * uv.getX(j))
      vertex.fromBufferAttribute(position, j)
      const inTree = vertex
        .clone()
        .sub(new Vector3(0, 4.6, 0))
        .normalize()
      vertex.sub(middle).normalize().add(inTree).addScaledVector(normalOf, 0.25).normalize()
      normal.setXYZ(j, vertex.x, vertex.y, vertex.z)
      colors.push(...leaves.map(part => part * shade))
    }
    return spray.setAttribute('color', new Float32BufferAttribute(colors, 3))
  })
  return [...parts, painted(ball(CORE * size).translate(x, y, z), LEAVES_SHADE)]
}

/**
 * A broad-leaved tree, 9 m high: clumps of leaves with gaps between them.
 *
 * @param sprays - Sprays of leaves of a clump.
 */
export function leafyTree(kind: keyof typeof CROWNS, sprays: number): BufferGeometry {
  const { clumps, leaves, bark, trunk: radius } = CROWNS[kind] as Crown
  const random = randomSequence(29)
  if (sprays < FEW) {
    const parts = clumps.flatMap(each => clump(each, sprays, leaves, random).slice(0, sprays))
    return mergeGeometries([...parts, trunk(5, radius, bark, 3)])
  }
  const parts = clumps.flatMap(each => clump(each, sprays, leaves, random))
  const limbs = clumps.slice(1, 5).map(([x, y, z]) => {
    const limb = trunk(Math.hypot(x, y - 2.2, z), 0.4 * radius, bark)
    const towards = new Vector3(x, y - 2.2, z)
    limb.rotateX(Math.acos(towards.y / towards.length())).rotateY(Math.atan2(x, z))
    return limb.translate(0, 2.2, 0)
  })
  return mergeGeometries([...parts, ...limbs, trunk(5.5, radius, bark)])
}

/** A crown of the distance: balls with an uneven outline. @param balls - Their number. */
export function distantTree(kind: keyof typeof CROWNS, balls: number): BufferGeometry {
  const { clumps, leaves, bark, trunk: radius } = CROWNS[kind] as Crown
  const random = randomSequence(7)
  const parts = clumps.slice(0, balls).map(([x, y, z, size]) => {
    const crown = ball(size * 1.12)
    const { position } = crown.attributes
    for (let i = 0; i < position.count; i++) {
      const bump = 0.7 + 0.55 * random()
      position.setXYZ(i, position.getX(i) * bump, position.getY(i) * bump, position.getZ(i) * bump)
    }
    return painted(crown.translate(x, y - 0.2, z), leaves, 0.5)
  })
  return mergeGeometries([...parts, trunk(4.5, radius, bark, 3)])
}
