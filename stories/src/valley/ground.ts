import { BufferAttribute, BufferGeometry, Group, MathUtils, Mesh, PlaneGeometry } from 'three'
import type { SurfaceWater } from '@welkin/atmosphere'
import { createNoiseTexture } from '../globe/detailNoise'
import {
  attribute,
  dFdx,
  dFdy,
  float,
  floor,
  Fn,
  fract,
  If,
  mix,
  normalWorldGeometry,
  positionView,
  positionWorld,
  sin,
  smoothstep,
  texture,
  transformNormalToView,
  vec2,
  vec3
} from 'three/tsl'
import type { Node } from 'three/webgpu'
import { ridges, smoothNoise } from './noise'
import { LAKE, VILLAGE } from './places'
import type { Relief } from './relief'
import { VertexLitMaterial } from './VertexLitMaterial'

/** Half width of the land [m]. */
const EXTENT = 45_000
/** Radius of the planet, away from which the land bends [m]. */
const RADIUS = 6_371_000

/** Smooth step, which may fall: `from` is where it is 0. */
const smooth = (from: number, to: number, t: number): number =>
  MathUtils.smoothstep((t - from) / (to - from), 0, 1)

/** Middle of the valley across it, at a place along it [m]. */
const valleyAt = (z: number): number =>
  500 * Math.sin(z / 3100 + 0.4) + 220 * Math.sin(z / 1270 + 1.1)

/** 0 at the middle of the lake, 1 at its shore. */
const lakeDistance = (x: number, z: number): number => {
  const bend = 130 * Math.sin(z / 420)
  return Math.hypot((x - LAKE.x - bend) / LAKE.halfWidth, (z - LAKE.z) / LAKE.halfLength)
}

/** Distance of grid lines from the middle over the land's half width, for lines of even numbers in [−1, 1]. */
const stretch = (t: number): number => 0.045 * t + 0.955 * t ** 3

/** Grid lines of the middle quality along half a side, and widths of quads that a ridge needs. */
const LINES = 256
const FINEST = 1.6

/** Width of quads at a distance from the middle [m]. */
function spacingAt(distance: number): number {
  const part = Math.min(distance / EXTENT, 1)
  const t = Math.cbrt(part)
  // One step of Newton's method from the cube root, which is a little more than the line's number.
  const line = t - (stretch(t) - part) / (0.045 + 2.865 * t * t)
  return (EXTENT * (0.045 + 2.865 * line * line)) / LINES
}

/** Width of the finest ridges that the grid of the middle quality has at a place [m]. */
export const finestAt = (x: number, z: number): number =>
  FINEST * spacingAt(Math.max(Math.abs(x), Math.abs(z)))

/** Height of the land above the water of the lake, on a plane [m]: a valley between mountains. */
function flatHeight(x: number, z: number): number {
  const across = Math.abs(x - valleyAt(z))
  // It ends in the north and opens in the south.
  const wall = Math.max(across, 0.8 * (-z - 5200))
  const width = 640 + 190 * Math.sin(z / 1700)
  const rise = MathUtils.clamp((wall - width) / 3400, 0, 1)
  const knolls = 14 * smoothNoise(x / 260, z / 260) + 3 * smoothNoise(x / 55, z / 55)
  const floor = 7 + 0.012 * Math.max(wall - 250, 0) + knolls * smooth(120, 700, wall)
  const height =
    floor + rise ** 1.25 * (260 + 2150 * ridges(x / 5200, z / 5200, finestAt(x, z) / 5200))
  const basin = smooth(1.25, 0.8, lakeDistance(x, z))
  return height + (-14 - height) * basin * smooth(150, 50, height)
}

/** Height of the ground, with the bend of the planet [m]. */
export const groundHeight = (x: number, z: number): number =>
  flatHeight(x, z) - (x * x + z * z) / (2 * RADIUS)

/** Share of forest at a place, in [0, 1]: on slopes up to the tree line. */
export function forestAt(x: number, z: number): number {
  const height = flatHeight(x, z)
  const patches = smoothNoise(x / 420, z / 420) + 0.5 * smoothNoise(x / 110, z / 110)
  const line = smooth(1250, 1000, height + 140 * smoothNoise(x / 300, z / 300))
  const foot = smooth(9, 34, height + 22 * patches)
  const village = smooth(150, 260, Math.hypot(x - VILLAGE.x, z - VILLAGE.z))
  const share = line * foot * smooth(-0.35, 0.1, patches) * village
  if (share === 0) return 0
  const slope = Math.hypot(
    flatHeight(x + 12, z) - flatHeight(x - 12, z),
    flatHeight(x, z + 12) - flatHeight(x, z - 12)
  )
  return share * smooth(32, 18, slope)
}

/** Colours of fields, linear sRGB: hay, ripe and young corn, earth. */
const CROPS = [
  [0.145, 0.145, 0.053],
  [0.185, 0.165, 0.07],
  [0.075, 0.115, 0.032],
  [0.13, 0.115, 0.068]
] as const

/** Width of a strip of fields [m]. */
const STRIP = 70

/** Height up to which land is farmed [m]. */
const FARMED = 40

/** Depth by which the snow line comes down while snow lies everywhere [m]. */
const FALLEN_SNOW = 2300

/** Half width of the road from the village to the lake [m]. */
const HALF_ROAD = 2.2

/** Fields in strips, with their furrows; grass in some. */
function crops(grass: Node<'vec3'>, distance: Node<'float'>): Node<'vec3'> {
  const { x, z } = positionWorld
  const across = x
    .div(STRIP)
    .add(sin(z.div(300)).mul(0.3))
    .toConst()
  const strip = floor(across).toConst()
  const row = floor(z.div(160).add(strip.mul(0.7))).toConst()
  const chance = fract(sin(strip.mul(127.1).add(row.mul(311.7))).mul(43.76)).toConst()
  let color = grass
  for (const [i, crop] of CROPS.entries()) {
    color = chance.greaterThan(0.4 + 0.15 * i).select(vec3(...crop), color)
  }
  // Furrows along the strips, until they are as fine as pixels.
  const furrows = sin(across.mul((2 * Math.PI * STRIP) / 2.6)).mul(smoothstep(170, 40, distance))
  return color.mul(furrows.mul(0.08).add(1))
}

/** Middle of the road that leads through the village to the lake, at a place along the valley [m]. */
export const roadMiddle = (z: number): number =>
  14 * Math.sin(z / 95) + 38 * Math.sin(z / 310) + VILLAGE.x - 44

/** True on that road, or beside it within some distance [m]. */
export const isOnRoad = (x: number, z: number, aside = 0): boolean =>
  z > -300 && Math.abs(x - roadMiddle(z)) < HALF_ROAD + aside

/** 1 on that road. Twin of the middle: {@link roadMiddle}. */
function roadAt(): Node<'float'> {
  const { x, z } = positionWorld
  const middle = sin(z.div(95))
    .mul(14)
    .add(sin(z.div(310)).mul(38))
    .add(VILLAGE.x - 44)
  const isSouth = smoothstep(-300, -285, z)
  return smoothstep(HALF_ROAD + 0.6, HALF_ROAD - 0.4, x.sub(middle).abs()).mul(isSouth)
}

/** Distance within which the finest grain of the ground is drawn [m]. */
const NEAR = 200

/** Colour and roughness of the ground: meadows, forest, rock, sand and snow by height and slope. */
function groundMaterial(
  { wetnessNode, snowCoverNode }: SurfaceWater,
  relief: Relief,
  lamplight: Node<'vec3'> | null
): VertexLitMaterial {
  const material = new VertexLitMaterial()
  const place = positionWorld.xz
  const picture = createNoiseTexture()
  // Each of its many scales is blurred far away: there are coarser ones. The finest are seen along the ground.
  const grazed = picture.clone()
  picture.anisotropy = 1
  grazed.anisotropy = 8
  for (const each of [picture, grazed]) {
    material.addEventListener('dispose', () => each.dispose())
  }
  // The coarsest of its five octaves has 8 cells a period; no two periods have a common multiple, and each is turned. Seen from
  // above: with heights in it, slopes that go with them have streaks.
  const turnedBy = (period: number): Node<'vec2'> => {
    const [cos, sine] = [Math.cos(period), Math.sin(period)].map(t => t / period)
    return vec2(place.dot(vec2(cos, sine)), place.dot(vec2(-sine, cos)))
  }
  const noise = (period: number): Node<'float'> =>
    texture(picture, turnedBy(period)).r.sub(0.5).mul(2)
  // A period that is a few pixels wide would show as a net.
  const distance = positionView.z.negate()
  const upTo = (metres: number): Node<'float'> => smoothstep(metres, metres / 4, distance)
  const broad = noise(1310).add(noise(4170)).mul(0.8).toVar()
  const patches = noise(390).mul(upTo(24_000)).toVar()
  const near = turnedBy(1.9).toVar()
  const [across, along] = [dFdx(near).toVar(), dFdy(near).toVar()]
  const grain = Fn(() => {
    const sum = noise(11.3).mul(0.6).mul(upTo(900)).toVar()
    If(distance.lessThan(NEAR), () => {
      const finest = texture(grazed, near).grad(across, along).r.sub(0.5).mul(1.6)
      sum.addAssign(finest.mul(upTo(NEAR)))
    })
    return sum
  })().toVar()
  const fine = grain
    .add(noise(71).mul(upTo(2500)))
    .add(patches)
    .toVar()
  const height = positionWorld.y.add(place.dot(place).div(2 * RADIUS)).toVar()
  const rough = broad.mul(0.5).add(patches).toVar()
  const normal = relief.normal(normalWorldGeometry).toVar()
  material.normalNode = transformNormalToView(normal)
  const slope = normal.y.oneMinus().add(fine.mul(0.02)).add(rough.mul(0.07)).toVar()
  const [forest, field] = [
    attribute<'vec2'>('cover', 'vec2').x,
    attribute<'vec2'>('cover', 'vec2').y
  ]
  const dry = broad.mul(0.6).add(fine.mul(0.45)).add(0.45).clamp()
  const meadow = mix(vec3(0.05, 0.09, 0.02), vec3(0.14, 0.135, 0.05), dry).toVar()
  const farmed = Fn(() => {
    const ground = meadow.toVar()
    If(height.lessThan(FARMED), () => {
      const tilled = mix(meadow, crops(meadow, distance), field)
      ground.assign(mix(tilled, vec3(0.24, 0.21, 0.17), roadAt()))
    })
    return ground
  })()
  const trees = mix(vec3(0.012, 0.022, 0.009), vec3(0.026, 0.04, 0.016), fine.add(0.5).clamp())
  const rock = mix(vec3(0.13, 0.125, 0.115), vec3(0.25, 0.235, 0.21), fine.mul(0.7).add(0.5))
  const alpine = mix(
    vec3(0.095, 0.1, 0.045),
    rock,
    smoothstep(1050, 1700, height.add(broad.mul(150)))
  )
  const bright = float(0.95).add(fine.mul(0.3)).add(grain.mul(0.12))
  let color: Node<'vec3'> = mix(farmed, alpine, smoothstep(550, 1050, height.add(broad.mul(120))))
  color = mix(color, vec3(0.17, 0.15, 0.12), smoothstep(2.6, 0.6, height.add(fine.mul(0.5))))
  color = mix(color, trees, forest)
  color = mix(color.mul(bright), rock.mul(bright), smoothstep(0.27, 0.42, slope))
  // Wet rough ground: of what it scatters, a share 1 − 1/n² comes back (Lekner & Dorf 1988).
  color = color.div(mix(vec3(1), color.oneMinus().mul(1.777).add(color), wetnessNode))
  const snowLine = height.add(snowCoverNode.mul(FALLEN_SNOW))
  const snow = smoothstep(1350, 1750, snowLine.add(broad.mul(170)).add(fine.mul(40)))
  const white = vec3(0.82, 0.84, 0.87).mul(rough.mul(0.07).add(1))
  color = mix(color, white, snow.mul(smoothstep(0.46, 0.3, slope)))
  material.colorNode = color
  material.emissiveNode = lamplight
  return material
}

/** Quads along a side of a tile, which is drawn if it is in sight. */
const TILE = 64

/** The vertices of a grid's tile. */
function tileOf(grid: BufferGeometry, quads: number, column: number, row: number): BufferGeometry {
  const size = Math.min(TILE, quads)
  const vertices: number[] = []
  for (let z = 0; z <= size; z++) {
    for (let x = 0; x <= size; x++) {
      vertices.push((row * size + z) * (quads + 1) + column * size + x)
    }
  }
  const tile = new BufferGeometry()
  for (const [name, { array, itemSize }] of Object.entries(
    grid.attributes as Record<string, BufferAttribute>
  )) {
    const values = new Float32Array(vertices.length * itemSize)
    vertices.forEach((vertex, i) => {
      for (let j = 0; j < itemSize; j++) values[i * itemSize + j] = array[vertex * itemSize + j]
    })
    tile.setAttribute(name, new BufferAttribute(values, itemSize))
  }
  return tile.setIndex(new PlaneGeometry(1, 1, size, size).index)
}

/**
 * The valley and its mountains, finer about the middle, in tiles.
 *
 * @param quads - Quads along a side, a multiple of 64.
 * @param water - Rain and snow on it.
 * @param relief - Its slopes between the grid's vertices.
 * @param lamplight - Light of lamps that it gives back.
 */
export function createGround(
  quads: number,
  water: SurfaceWater,
  relief: Relief,
  lamplight: Node<'vec3'> | null = null
): Group {
  const geometry = new PlaneGeometry(2, 2, quads, quads).rotateX(-Math.PI / 2)
  geometry.deleteAttribute('uv')
  const positions = geometry.attributes.position as BufferAttribute
  const cover = new Float32Array(2 * positions.count)
  for (let i = 0; i < positions.count; i++) {
    const x = EXTENT * stretch(positions.getX(i))
    const z = EXTENT * stretch(positions.getZ(i))
    positions.setXYZ(i, x, groundHeight(x, z), z)
    cover[2 * i] = forestAt(x, z)
    cover[2 * i + 1] = fieldAt(x, z)
  }
  geometry.setAttribute('cover', new BufferAttribute(cover, 2))
  geometry.computeVertexNormals()
  const ground = new Group()
  const material = groundMaterial(water, relief, lamplight)
  const along = Math.max(quads / TILE, 1)
  for (let i = 0; i < along ** 2; i++) {
    const tile = tileOf(geometry, quads, i % along, Math.floor(i / along))
    const mesh = new Mesh(tile, material)
    // Tiles at their places are drawn from near to far, so that hills hide what is behind them.
    tile.computeBoundingSphere()
    mesh.position.copy(tile.boundingSphere!.center)
    tile.translate(...mesh.position.clone().negate().toArray())
    mesh.castShadow = mesh.receiveShadow = true
    ground.add(mesh)
  }
  return ground
}

/** Place across the valley of a border between two strips of fields, at a place along it [m]. */
export const fieldBorder = (number: number, z: number): number =>
  STRIP * (number - 0.3 * Math.sin(z / 300))

/** True where fields are, and grass between them. */
export const isField = (x: number, z: number): boolean => fieldAt(x, z) > 0.5

/** 1 where fields may be: on the valley's floor, away from the village. */
function fieldAt(x: number, z: number): number {
  const height = flatHeight(x, z)
  const village = smooth(130, 175, Math.hypot(x - VILLAGE.x, z - VILLAGE.z))
  return smooth(FARMED, 20, height) * smooth(4, 8, height) * village
}
