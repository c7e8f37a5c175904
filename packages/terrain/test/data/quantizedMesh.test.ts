import fc from 'fast-check'
import * as plugins from '3d-tiles-renderer/core/plugins'
import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import {
  QuantizedMeshTiles,
  type QuantizedMeshTilesOptions
} from '../../src/data/QuantizedMeshTiles'
import { rasterizeMesh, type QuantizedMesh } from '../../src/data/rasterizeMesh'
import { degreesOf, earth, hills, pageAt, partsOf } from './tiles'

// The package has no type of it.
const { QuantizedMeshLoaderBase } = plugins as unknown as {
  QuantizedMeshLoaderBase: new () => { parse(buffer: ArrayBuffer): QuantizedMesh }
}
const loader = new QuantizedMeshLoaderBase()
const never = new AbortController().signal
const LOWEST = 0
const HIGHEST = 3000
const MOST = 32_767

/** Bytes of a tile with a grid of corners: of the format's header, then differences in zigzag, then marks of indices. */
function quantizedMesh(z: number, x: number, y: number, heightOf = hills, side = 65): ArrayBuffer {
  const corners = side * side
  const triangles = 2 * (side - 1) ** 2
  const indices: number[] = []
  for (let j = 0; j < side - 1; j++) {
    for (let i = 0; i < side - 1; i++) {
      const at = j * side + i
      indices.push(at, at + 1, at + side, at + 1, at + side + 1, at + side)
    }
  }
  const view = new DataView(new ArrayBuffer(88 + 4 + 6 * corners + 4 + 6 * triangles + 16))
  view.setFloat32(24, LOWEST, true)
  view.setFloat32(28, HIGHEST, true)
  let at = 88
  view.setUint32(at, corners, true)
  at += 4
  const extent = 180 / 2 ** z
  const values = [0, 1, 2].map(part =>
    Array.from({ length: corners }, (_, i) => {
      const [u, v] = [(i % side) / (side - 1), Math.floor(i / side) / (side - 1)]
      // Rows of addresses here are from the north.
      const height = heightOf(-180 + (x + u) * extent, 90 - (y + 1 - v) * extent)
      return Math.round(MOST * [u, v, (height - LOWEST) / (HIGHEST - LOWEST)][part])
    })
  )
  for (const numbers of values) {
    let last = 0
    for (const number of numbers) {
      const step = number - last
      view.setUint16(at, step < 0 ? -2 * step - 1 : 2 * step, true)
      last = number
      at += 2
    }
  }
  view.setUint32(at, triangles, true)
  at += 4
  // A corner ahead of its turn has a negative mark, which wraps as it is read.
  const order: number[] = []
  let highest = 0
  for (const index of indices) {
    order.push(highest - index)
    if (highest === index) highest++
  }
  for (const code of order) {
    view.setUint16(at, code, true)
    at += 2
  }
  return view.buffer
}

/** Tiles of hills, from a loader that may fail. */
function tilesOf(
  load: (z: number, x: number, y: number) => ArrayBuffer | null = quantizedMesh,
  options: QuantizedMeshTilesOptions = {}
) {
  return new QuantizedMeshTiles('{z}/{x}/{y}', buffer => loader.parse(buffer), {
    maxZoom: 5,
    retries: 0,
    ...options,
    loadTile: async url => Promise.resolve(load(...partsOf(url)))
  })
}

const sampleAt = (tiles: QuantizedMeshTiles, longitude: number, latitude: number) =>
  tiles.sampleAt(earth.geodeticToECEF({ longitude, latitude }), {
    height: 0,
    gradient: new Vector3()
  })

describe('tiles of quantised meshes', () => {
  it.each([
    [10.3, 47.2],
    [-179.99, -33],
    [45, 89.9]
  ])('have the heights of the data about %d°, %d°', async (longitude, latitude) => {
    const tiles = tilesOf()
    const request = pageAt(longitude, latitude, 7)
    const heights = await tiles.loadHeights(request, never)
    for (const [i, place] of degreesOf(request).entries()) {
      expect(Math.abs(heights[i] - hills(place.longitude, place.latitude))).toBeLessThan(4)
    }
  })

  it('have the gradient of their heights on the CPU', async () => {
    const tiles = tilesOf()
    await tiles.loadHeights(pageAt(10.3, 47.2, 7), never)
    const { longitude, latitude } = degreesOf(pageAt(10.3, 47.2, 7))[40]
    const { height, gradient } = sampleAt(tiles, longitude, latitude)
    const step = 1e-3
    for (const [east, north] of [
      [step, 0],
      [0, step]
    ]) {
      const there = { longitude: longitude + east, latitude: latitude + north }
      const way = earth.geodeticToECEF(there).sub(earth.geodeticToECEF({ longitude, latitude }))
      const rise = sampleAt(tiles, there.longitude, there.latitude).height - height
      expect(gradient.dot(way)).toBeCloseTo(rise, 2)
      expect(Math.abs(rise)).toBeGreaterThan(0.02)
    }
  })

  it('show coarser ones where one is missing or corrupt', async () => {
    const request = pageAt(10.3, 47.2, 7)
    for (const broken of [null, new ArrayBuffer(3), new ArrayBuffer(400)]) {
      const tiles = tilesOf((z, x, y) => (z === 5 ? broken : quantizedMesh(z, x, y)))
      const heights = await tiles.loadHeights(request, never)
      for (const [i, { longitude, latitude }] of degreesOf(request).entries()) {
        expect(Math.abs(heights[i] - hills(longitude, latitude))).toBeLessThan(20)
      }
    }
  })

  it('reject what is no option or function', () => {
    const make =
      (parse: unknown, options = {}) =>
      () =>
        new QuantizedMeshTiles('{z}/{x}/{y}', parse as never, options)
    expect(make(null)).toThrow('QuantizedMeshTiles: parse must be a function, got null')
    const parse = () => null as never
    expect(make(parse, { loadTile: 3 })).toThrow('QuantizedMeshTiles: loadTile must be a function')
    expect(make(parse, { loadPixels: parse })).toThrow(
      'QuantizedMeshTiles: loadPixels must be loadTile'
    )
    expect(make(parse, { zoom: 3 })).toThrow("QuantizedMeshTiles: unknown option 'zoom'")
  })
})

describe('a mesh', () => {
  const unit = fc.double({ min: 0, max: 1, noNaN: true })

  it('is a plane wherever its corners are on one, without holes', () => {
    fc.assert(
      fc.property(unit, unit, fc.integer({ min: 2, max: 40 }), (x, y, size) => {
        const [u, v] = [
          [0, 1, 1, 0, x],
          [0, 0, 1, 1, y]
        ]
        const mesh = {
          header: { minHeight: 100, maxHeight: 400 },
          indices: [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4],
          vertexData: { u, v, height: u.map((_, i) => 0.6 * u[i] + 0.4 * v[i]) }
        }
        for (const [i, height] of rasterizeMesh(mesh, size).entries()) {
          const [west, south] = [((i % size) + 0.5) / size, 1 - (Math.floor(i / size) + 0.5) / size]
          expect(height).toBeCloseTo(100 + 300 * (0.6 * west + 0.4 * south), 0)
        }
      })
    )
  })

  it('has no heights beside its triangles, nor by corners that are not there', () => {
    const mesh = {
      header: { minHeight: 0, maxHeight: 1 },
      indices: [0, 1, 2, 0, 1, 9, 0, 1, 1],
      vertexData: { u: [0, 0.5, 0], v: [1, 1, 0.5], height: [1, 1, 1] }
    }
    const heights = rasterizeMesh(mesh, 8)
    expect(heights[0]).toBe(1)
    expect(heights[7]).toBeNaN()
    expect(heights.filter(Number.isFinite)).toHaveLength(10)
  })
})
