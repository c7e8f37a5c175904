import { BufferGeometry, Color, Float32BufferAttribute } from 'three'
import type { Obstacle } from '../moving/obstacles'
import { randomSequence } from '../random'

/** Distance between the middles of neighbouring streets, across and along the main street [m]. */
export const BLOCK = { width: 78, depth: 96 }
/** Width of a street between the buildings' fronts [m]. */
export const STREET_WIDTH = 18
/** Half the side of the square that is built on [m]. */
export const CITY_EXTENT = 900

const FACADES = [
  '#b8b2a6',
  '#9a9da0',
  '#c9c1b2',
  '#84807c',
  '#a7957f',
  '#d2cfc8',
  '#767c84',
  '#b39f92'
]

interface Box {
  x: number
  z: number
  width: number
  depth: number
  height: number
  color: Color
}

export interface Point {
  x: number
  z: number
}

function layOut(): { boxes: Box[]; trees: Point[] } {
  const random = randomSequence(1868)
  const boxes: Box[] = []
  const trees: Point[] = []
  const across = Math.floor(CITY_EXTENT / BLOCK.width)
  const along = Math.floor(CITY_EXTENT / BLOCK.depth)
  for (let column = -across; column < across; column++) {
    for (let row = -along; row < along; row++) {
      const left = column * BLOCK.width + STREET_WIDTH / 2
      const near = row * BLOCK.depth + STREET_WIDTH / 2
      const width = BLOCK.width - STREET_WIDTH
      const depth = BLOCK.depth - STREET_WIDTH
      const fromCentre = Math.hypot(left + width / 2, near + depth / 2) / CITY_EXTENT
      if (random() < 0.06 && fromCentre > 0.15) {
        for (let i = 0; i < 40; i++) {
          trees.push({ x: left + random() * width, z: near + random() * depth })
        }
        continue
      }
      for (let lot = 0; lot < 8; lot++) {
        const lotWidth = width / 2
        const lotDepth = depth / 4
        if (random() < (fromCentre - 0.4) * 1.4) {
          continue
        }
        const gap = 0.8 + random() * 2.5
        const height =
          3.5 *
          Math.round(2 + random() ** 2.2 * 22 * Math.max(1 - fromCentre * 1.3, 0.06) + random() * 3)
        boxes.push({
          x: left + lotWidth * ((lot % 2) + 0.5),
          z: near + lotDepth * (Math.floor(lot / 2) + 0.5),
          width: lotWidth - gap,
          depth: lotDepth - gap,
          height: random() < 0.03 && fromCentre < 0.5 ? height + 60 : height,
          color: new Color(FACADES[Math.floor(random() * FACADES.length)]).multiplyScalar(
            0.55 + random() * 0.35
          )
        })
      }
    }
  }
  for (let z = -CITY_EXTENT; z < CITY_EXTENT; z += 11) {
    for (const side of [-1, 1]) {
      if (
        Math.abs(((z / BLOCK.depth) % 1) - Math.round((z / BLOCK.depth) % 1)) * BLOCK.depth >
        STREET_WIDTH / 2 + 2
      ) {
        trees.push({ x: side * (STREET_WIDTH / 2 - 2.2), z: z + random() })
      }
    }
  }
  return { boxes, trees }
}

/**
 * Boxes along streets, the same on every run. The main street runs along z through the origin; y is up.
 *
 * Texture coordinates are metres along and up a wall, and (0, 0) on roofs.
 */
export function createBuildings(): {
  geometry: BufferGeometry
  trees: Point[]
  obstacles: Obstacle[]
} {
  const { boxes, trees } = layOut()
  const positions: number[] = []
  const normals: number[] = []
  const uvs: number[] = []
  const colors: number[] = []
  const indices: number[] = []

  const quad = (
    corners: number[][],
    normal: number[],
    width: number,
    height: number,
    color: Color
  ): void => {
    const first = positions.length / 3
    corners.forEach((corner, i) => {
      positions.push(...corner)
      normals.push(...normal)
      uvs.push(i === 1 || i === 2 ? width : 0, i >= 2 ? height : 0)
      colors.push(color.r, color.g, color.b)
    })
    indices.push(first, first + 1, first + 2, first, first + 2, first + 3)
  }

  for (const { x, z, width, depth, height, color } of boxes) {
    const [x0, x1, z0, z1] = [x - width / 2, x + width / 2, z - depth / 2, z + depth / 2]
    const wall = (ax: number, az: number, bx: number, bz: number, normal: number[]): void => {
      const length = Math.hypot(bx - ax, bz - az)
      quad(
        [
          [ax, 0, az],
          [bx, 0, bz],
          [bx, height, bz],
          [ax, height, az]
        ],
        normal,
        length,
        height,
        color
      )
    }
    wall(x0, z1, x1, z1, [0, 0, 1])
    wall(x1, z1, x1, z0, [1, 0, 0])
    wall(x1, z0, x0, z0, [0, 0, -1])
    wall(x0, z0, x0, z1, [-1, 0, 0])
    const roof = new Color(0.28, 0.28, 0.29)
    quad(
      [
        [x0, height, z1],
        [x1, height, z1],
        [x1, height, z0],
        [x0, height, z0]
      ],
      [0, 1, 0],
      0,
      0,
      roof
    )
  }

  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3))
  geometry.setAttribute('normal', new Float32BufferAttribute(normals, 3))
  geometry.setAttribute('uv', new Float32BufferAttribute(uvs, 2))
  geometry.setAttribute('color', new Float32BufferAttribute(colors, 3))
  geometry.setIndex(indices)
  return {
    geometry,
    trees,
    obstacles: boxes.map(({ x, z, width, depth, height }) => ({ x, z, width, depth, top: height }))
  }
}
