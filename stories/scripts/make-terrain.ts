/**
 * Makes the globe story's local terrain: a 3D Tiles 1.1 tileset of real heights, a quadtree of binary glTF.
 *
 *     npx tsx stories/scripts/make-terrain.ts [directory]
 *
 * Heights above sea level are used as heights above the ellipsoid, which puts the land about 30 m too high there.
 */
import { createHash } from 'node:crypto'
import { existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'
import { fileURLToPath, pathToFileURL } from 'node:url'
import { Elevation } from './terrain/elevation.ts'
import { encodeGLB } from './terrain/glb.ts'
import { makeTile, TILE_CELLS } from './terrain/tile.ts'

const LEVELS = 4
const CELLS = TILE_CELLS * 2 ** (LEVELS - 1)
/** Upper bound of the height of trees and houses [m]. */
const TREE_HEIGHT = 20
const DATA = new URL('../data/', import.meta.url)
export const TERRAIN_DIRECTORY = fileURLToPath(new URL('../.cache/terrain', import.meta.url))

interface TilesetNode {
  boundingVolume: { region: number[] }
  geometricError: number
  refine: 'REPLACE'
  content: { uri: string }
  children?: TilesetNode[]
}

/** The farthest that a mesh with a vertex every `step` samples is from the samples [m]. */
function meshError(grid: Elevation, row: number, column: number, step: number): number {
  let error = 0
  for (let y = row; y <= row + TILE_CELLS * step; y++) {
    for (let x = column; x <= column + TILE_CELLS * step; x++) {
      error = Math.max(error, Math.abs(grid.onTriangles(y, x, step) - grid.at(y, x)))
    }
  }
  return error
}

function heightRange(grid: Elevation, row: number, column: number, step: number): [number, number] {
  let low = Infinity
  let high = -Infinity
  for (let y = row; y <= row + TILE_CELLS * step; y++) {
    for (let x = column; x <= column + TILE_CELLS * step; x++) {
      low = Math.min(low, grid.at(y, x))
      high = Math.max(high, grid.at(y, x))
    }
  }
  return [low, high]
}

/** Writes the tileset, and returns how many tiles and bytes it has. */
export function makeTerrain(directory: string): { tiles: number; bytes: number } {
  const grid = Elevation.read(DATA, CELLS)
  mkdirSync(directory, { recursive: true })
  const total = { tiles: 0, bytes: 0 }

  const addNode = (level: number, y: number, x: number): TilesetNode => {
    const step = 2 ** (LEVELS - 1 - level)
    const row = y * TILE_CELLS * step
    const column = x * TILE_CELLS * step
    const children =
      level === LEVELS - 1
        ? undefined
        : [0, 1, 2, 3].map(i => addNode(level + 1, y * 2 + (i >> 1), x * 2 + (i & 1)))
    const error = meshError(grid, row, column, step)
    // A neighbour may be one level coarser, so the skirt must bridge its error and this tile's own.
    const skirt = 40 * 2 ** (LEVELS - 1 - level)
    const uri = `${level}-${y}-${x}.glb`
    const glb = encodeGLB(makeTile(grid, row, column, step, skirt))
    writeFileSync(join(directory, uri), glb)
    total.tiles++
    total.bytes += glb.length
    const [low, high] = heightRange(grid, row, column, step)
    const radians = (degrees: number): number => (degrees * Math.PI) / 180
    return {
      boundingVolume: {
        region: [
          radians(grid.longitude(column)),
          radians(grid.latitude(row + TILE_CELLS * step)),
          radians(grid.longitude(column + TILE_CELLS * step)),
          radians(grid.latitude(row)),
          low - skirt,
          high + TREE_HEIGHT
        ]
      },
      geometricError: children
        ? Math.max(error, ...children.map(child => child.geometricError + 1))
        : 0,
      refine: 'REPLACE',
      content: { uri },
      children
    }
  }

  const root = addNode(0, 0, 0)
  const tileset = { asset: { version: '1.1' }, geometricError: root.geometricError * 2, root }
  writeFileSync(join(directory, 'tileset.json'), JSON.stringify(tileset))
  return total
}

function fingerprint(): string {
  const hash = createHash('sha256')
  const sources = readdirSync(new URL('terrain/', import.meta.url)).map(
    name => new URL(`terrain/${name}`, import.meta.url)
  )
  for (const url of [
    new URL('jacksboro-dem.i16.gz', DATA),
    new URL('make-terrain.ts', import.meta.url),
    ...sources
  ]) {
    hash.update(readFileSync(url))
  }
  return hash.digest('hex')
}

/** Makes the tileset unless it is there already, made from the same figures by the same code. */
export function ensureTerrain(directory = TERRAIN_DIRECTORY): string {
  const stamp = join(directory, 'made-from.txt')
  const current = fingerprint()
  if (!existsSync(stamp) || readFileSync(stamp, 'utf8') !== current) {
    makeTerrain(directory)
    writeFileSync(stamp, current)
  }
  return directory
}

if (process.argv[1] !== undefined && import.meta.url === pathToFileURL(process.argv[1]).href) {
  const directory = process.argv[2] ?? TERRAIN_DIRECTORY
  const { tiles, bytes } = makeTerrain(directory)
  console.log(`${tiles} tiles, ${(bytes / 1e6).toFixed(1)} MB in ${directory}`)
}
