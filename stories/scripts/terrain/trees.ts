import { woodland } from './colours.ts'
import type { Elevation } from './elevation.ts'
import type { Primitive } from './glb.ts'
import { noise } from './noise.ts'
import { gradient, localFrame, toECEF } from './ellipsoid.ts'
import type { Vec3 } from './ellipsoid.ts'

/** Trees stand around here, where the story's valley camera is. */
const GROVE = { longitude: -84.178, latitude: 36.622, radius: 2300, clearing: 45 }
/** Candidates for a tree along a side of a cell of 75 m × 93 m. */
const TREES_PER_CELL = 3

const PHI = (1 + Math.sqrt(5)) / 2
/** Icosahedron. */
const CROWN: Vec3[] = [
  [-1, PHI, 0],
  [1, PHI, 0],
  [-1, -PHI, 0],
  [1, -PHI, 0],
  [0, -1, PHI],
  [0, 1, PHI],
  [0, -1, -PHI],
  [0, 1, -PHI],
  [PHI, 0, -1],
  [PHI, 0, 1],
  [-PHI, 0, -1],
  [-PHI, 0, 1]
].map(([x, y, z]) => [x / 1.902, y / 1.902, z / 1.902])
const CROWN_FACES = [
  0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8,
  3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1
]
const TRUNK: Vec3[] = [
  [1, 0, 0],
  [-0.5, 0.87, 0],
  [-0.5, -0.87, 0],
  [1, 0, 1],
  [-0.5, 0.87, 1],
  [-0.5, -0.87, 1]
]
const TRUNK_FACES = [0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 2, 0, 3, 2, 3, 5]

/** Made-up trees for scale: dense where the ground is coloured as wood, a few in the pastures. */
export function treesOfTile(
  grid: Elevation,
  row: number,
  column: number,
  cells: number,
  centre: Vec3
): Primitive | null {
  const positions: number[] = []
  const normals: number[] = []
  const colors: number[] = []
  const indices: number[] = []

  const add = (
    shape: Vec3[],
    faces: number[],
    place: (v: Vec3) => [at: Vec3, normal: Vec3],
    color: number[]
  ): void => {
    const first = positions.length / 3
    for (const corner of shape) {
      const [at, normal] = place(corner)
      positions.push(...at)
      normals.push(...normal.map(n => Math.round(n * 32767)), 0)
      colors.push(...color, 255)
    }
    indices.push(...faces.map(i => first + i))
  }

  for (let i = 0; i < cells * TREES_PER_CELL; i++) {
    for (let j = 0; j < cells * TREES_PER_CELL; j++) {
      const keyRow = row * TREES_PER_CELL + i
      const keyColumn = column * TREES_PER_CELL + j
      const random = (channel: number): number => noise(keyRow * 7 + channel * 1013, keyColumn * 7)
      const gridRow = (keyRow + random(0)) / TREES_PER_CELL
      const gridColumn = (keyColumn + random(1)) / TREES_PER_CELL
      const latitude = grid.latitude(gridRow)
      const longitude = grid.longitude(gridColumn)
      const distance = Math.hypot(
        (latitude - GROVE.latitude) * 111_000,
        (longitude - GROVE.longitude) * 89_200
      )
      if (distance > GROVE.radius || distance < GROVE.clearing) {
        continue
      }
      const height = grid.onTriangles(gridRow, gridColumn)
      const slope = Math.hypot(...gradient(grid, Math.round(gridRow), Math.round(gridColumn)))
      const wooded = woodland(height, slope, gridRow, gridColumn)
      if (random(2) > (0.02 + wooded * 0.9) * (1 - (distance / GROVE.radius) ** 3)) {
        continue
      }
      const foot = toECEF(latitude, longitude, height)
      const { east, north, up } = localFrame(latitude, longitude)
      const width = 2.4 + random(3) * 2.2
      const tall = width * (1.2 + random(4) * 0.6)
      const stem = 1.2 + random(5) * 1.5
      const along = (x: number, y: number, z: number): Vec3 =>
        [0, 1, 2].map(k => x * east[k] + y * north[k] + z * up[k]) as Vec3
      const fromCentre = (offset: Vec3): Vec3 =>
        [0, 1, 2].map(k => foot[k] - centre[k] + offset[k]) as Vec3
      const lump = random(6) * 6
      const shade = 0.6 + random(7) * 0.5
      add(
        CROWN,
        CROWN_FACES,
        ([x, y, z]) => {
          const bump = width * (1 + 0.22 * Math.sin(x * 3 + lump) * Math.cos(y * 4 + z * 3))
          return [fromCentre(along(x * bump, y * bump, stem + (z + 0.95) * tall)), along(x, y, z)]
        },
        [17 * shade, 27 * shade, 9 * shade].map(Math.round)
      )
      add(
        TRUNK,
        TRUNK_FACES,
        ([x, y, z]) => [
          fromCentre(along(x * 0.22, y * 0.22, z * (stem + tall) - 0.5)),
          along(x, y, 0)
        ],
        [14, 11, 8]
      )
    }
  }
  if (indices.length === 0) {
    return null
  }
  return {
    positions: new Float32Array(positions),
    normals: new Int16Array(normals),
    colors: new Uint8Array(colors),
    indices: new Uint32Array(indices)
  }
}
