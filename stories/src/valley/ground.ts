import { BufferAttribute, BufferGeometry, Group, MathUtils, Mesh, PlaneGeometry } from 'three'
import type { SurfaceWater } from '@welkin/atmosphere'
import type { Node } from 'three/webgpu'
import { HALF_ROAD, STRIP } from './fields'
import { tileIndex } from './drawOrder'
import { FARMED, groundMaterial, RADIUS } from './groundMaterial'
import { ridges, smoothNoise } from './noise'
import { LAKE, VILLAGE } from './places'
import type { OpenSky } from './OpenSky'
import type { Relief } from './relief'

/** Half width of the land [m]. */
const EXTENT = 45_000

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

/** Middle of the road that leads through the village to the lake, at a place along the valley [m]. */
export const roadMiddle = (z: number): number =>
  14 * Math.sin(z / 95) + 38 * Math.sin(z / 310) + VILLAGE.x - 44

/** True on that road, or beside it within some distance [m]. */
export const isOnRoad = (x: number, z: number, aside = 0): boolean =>
  z > -300 && Math.abs(x - roadMiddle(z)) < HALF_ROAD + aside

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
  return tile
}

/**
 * The valley and its mountains, finer about the middle, in tiles.
 *
 * @param quads - Quads along a side, a multiple of 64.
 * @param water - Rain and snow on it.
 * @param relief - Its slopes between the grid's vertices.
 * @param lamplight - Light of lamps that it gives back.
 * @param sky - Part of the sky that it sees.
 */
export function createGround(
  quads: number,
  water: SurfaceWater,
  relief: Relief,
  lamplight: Node<'vec3'> | null = null,
  sky: OpenSky | null = null
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
  const material = groundMaterial(water, relief, lamplight, sky)
  const along = Math.max(quads / TILE, 1)
  const index = tileIndex(Math.min(TILE, quads))
  for (let i = 0; i < along ** 2; i++) {
    const tile = tileOf(geometry, quads, i % along, Math.floor(i / along))
    const mesh = new Mesh(tile.setIndex(index), material)
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
