import { groundColour } from './colours.ts'
import type { Elevation } from './elevation.ts'
import { gradient, localFrame, toECEF } from './ellipsoid.ts'
import type { Tile } from './glb.ts'
import { encodePNG } from './png.ts'
import { treesOfTile } from './trees.ts'

/** Cells along a side of a tile's mesh, whatever its level. */
export const TILE_CELLS = 72
const TEXELS = 192

/** The tile whose north-west vertex is (row, column), with a vertex every `step` samples and a skirt around it. */
export function makeTile(
  grid: Elevation,
  row: number,
  column: number,
  step: number,
  skirt: number
): Tile {
  const side = TILE_CELLS + 1
  const skirtCount = 4 * side
  const count = side * side + skirtCount
  const positions = new Float32Array(count * 3)
  const normals = new Int16Array(count * 4)
  const uvs = new Float32Array(count * 2)
  const middle = (TILE_CELLS * step) / 2
  const centre = toECEF(
    grid.latitude(row + middle),
    grid.longitude(column + middle),
    grid.at(row + middle, column + middle)
  )

  const setVertex = (vertex: number, y: number, x: number, drop: number): void => {
    const gridRow = row + y * step
    const gridColumn = column + x * step
    const latitude = grid.latitude(gridRow)
    const longitude = grid.longitude(gridColumn)
    const position = toECEF(latitude, longitude, grid.at(gridRow, gridColumn) - drop)
    const frame = localFrame(latitude, longitude)
    const [toEast, toNorth] = gradient(grid, gridRow, gridColumn)
    const length = Math.hypot(toEast, toNorth, 1)
    for (let i = 0; i < 3; i++) {
      positions[vertex * 3 + i] = position[i] - centre[i]
      const normal = (frame.up[i] - toEast * frame.east[i] - toNorth * frame.north[i]) / length
      normals[vertex * 4 + i] = Math.round(normal * 32767)
    }
    // Vertices on the border fall on the centres of the border's texels, which neighbours share.
    uvs[vertex * 2] = (0.5 + (x / TILE_CELLS) * (TEXELS - 1)) / TEXELS
    uvs[vertex * 2 + 1] = (0.5 + (y / TILE_CELLS) * (TEXELS - 1)) / TEXELS
  }

  const indices: number[] = []
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) {
      setVertex(y * side + x, y, x, 0)
      if (y < TILE_CELLS && x < TILE_CELLS) {
        const corner = y * side + x
        indices.push(
          corner,
          corner + side,
          corner + 1,
          corner + 1,
          corner + side,
          corner + side + 1
        )
      }
    }
  }

  // Borders in the order that keeps the tile on the left, so that every skirt faces outwards.
  const borders: ((i: number) => [y: number, x: number])[] = [
    i => [i, 0],
    i => [TILE_CELLS, i],
    i => [TILE_CELLS - i, TILE_CELLS],
    i => [0, TILE_CELLS - i]
  ]
  borders.forEach((border, b) => {
    for (let i = 0; i < side; i++) {
      const [y, x] = border(i)
      const low = side * side + b * side + i
      setVertex(low, y, x, skirt)
      if (i < TILE_CELLS) {
        const [nextY, nextX] = border(i + 1)
        const high = y * side + x
        const nextHigh = nextY * side + nextX
        indices.push(high, low, nextHigh, nextHigh, low, low + 1)
      }
    }
  })
  const ground = { positions, normals, uvs, indices: new Uint16Array(indices) }
  const trees = step === 1 ? treesOfTile(grid, row, column, TILE_CELLS, centre) : null
  return {
    centre,
    primitives: trees === null ? [ground] : [ground, trees],
    image: tileImage(grid, row, column, step)
  }
}

function tileImage(grid: Elevation, row: number, column: number, step: number): Uint8Array {
  const rgb = new Uint8Array(TEXELS * TEXELS * 3)
  const samplesPerTexel = (TILE_CELLS * step) / (TEXELS - 1)
  for (let y = 0; y < TEXELS; y++) {
    for (let x = 0; x < TEXELS; x++) {
      const gridRow = row + y * samplesPerTexel
      const gridColumn = column + x * samplesPerTexel
      const height = grid.onTriangles(gridRow, gridColumn)
      const slope = Math.hypot(...gradient(grid, Math.round(gridRow), Math.round(gridColumn)))
      rgb.set(
        groundColour(height, slope, gridRow, gridColumn, grid.outside(gridRow, gridColumn)),
        (y * TEXELS + x) * 3
      )
    }
  }
  return encodePNG(rgb, TEXELS, TEXELS)
}
