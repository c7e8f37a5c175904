import fc from 'fast-check'
import { GridHeights, TerrariumTiles } from '@welkin/terrain'
import { describe, expect, it } from 'vitest'
import { skyShare } from '../src/pages/cpu/skyShare'
import { degreesOf, pageAt, partsOf, terrariumTile } from './data/tiles'

const slopes = fc.double({ min: -2, max: 2, noNaN: true })

it('is the whole sky on a slope, however steep, and on a summit', () => {
  fc.assert(
    fc.property(slopes, slopes, (a, b) => {
      expect(skyShare((east, north) => a * east + b * north, a, b)).toBeCloseTo(1, 12)
      expect(skyShare((east, north) => -Math.hypot(east, north), 0, 0)).toBe(1)
    })
  )
})

it('is cos² of the horizon at the bottom of a cone', () => {
  fc.assert(
    fc.property(fc.double({ min: 0, max: 80, noNaN: true }), degrees => {
      const angle = (degrees * Math.PI) / 180
      const cone = (east: number, north: number): number =>
        Math.tan(angle) * Math.hypot(east, north)
      expect(skyShare(cone, 0, 0)).toBeCloseTo(Math.cos(angle) ** 2, 9)
    })
  )
})

it('falls with the height of a wall', () => {
  const by = (height: number): number => skyShare((_, north) => (north > 50 ? height : 0), 0, 0)
  expect(by(200)).toBeLessThan(by(100))
  expect(by(100)).toBeLessThan(1)
  expect(by(1e6)).toBeGreaterThan(0.3)
})

describe('of measured heights', () => {
  /** A valley along a meridian, 45° steep on both sides. */
  const METERS = 111_320 * Math.cos((47 * Math.PI) / 180)
  const valley = (longitude: number): number =>
    Math.min(Math.abs(longitude - 8.1) * METERS, 8000) + 300
  const grid = new GridHeights(
    Float32Array.from({ length: 600 * 40 }, (_, i) => valley(8 + ((i % 600) + 0.5) / 3000)),
    { width: 600, height: 40, west: 8, east: 8.2, south: 46.9, north: 47.1 }
  )
  const tiles = new TerrariumTiles((z, x, y) => `${z}/${x}/${y}`, {
    size: 64,
    maxZoom: 14,
    loadPixels: url => Promise.resolve(terrariumTile(...partsOf(url), valley))
  })
  // Both sides at the bottom; far up one side the other is a wall, 1,200 m away.
  const expected = (away: number): number => {
    const [near, far] = [150, 1200].map(d => Math.max(Math.abs(d - away) - away + d, 0) / d)
    const wall = 1 / (1 + Math.max(near, far) ** 2)
    return (away < 1 ? 2 * 0.5 + 2 : wall + 3) / 4
  }

  it.each(['grid', 'tiles'])('follows the pages of a %s', async kind => {
    const page = { ...pageAt(8.1, 47, 12, 96), vertices: 25 }
    const source = kind === 'grid' ? grid : tiles
    const { signal } = new AbortController()
    // As a terrain does, those that it is a part of first: beyond the page's own tiles of data their ground is known.
    for (const level of [8, 9, 10, 11]) await source.loadHeights(pageAt(8.1, 47, level, 96), signal)
    const heights = await source.loadHeights(page, signal)
    const { side } = page
    expect(heights.length).toBe(side ** 2 + 25 ** 2)
    const places = degreesOf(page)
    let [least, most] = [1, 0]
    // Corners of the cells that shares are found at.
    for (let n = 0; n < 25 ** 2; n++) {
      const [column, row] = [n % 25, Math.floor(n / 25)]
      if (column % 4 !== 0 || row % 4 !== 0) continue
      const { longitude } = places[(1 + 4 * row) * side + 1 + 4 * column]
      const away = Math.abs(longitude - 8.1) * METERS
      const share = heights[side ** 2 + n]
      if (away > 150) expect(Math.abs(share - expected(away))).toBeLessThan(0.03)
      least = Math.min(least, share)
      most = Math.max(most, share)
    }
    expect(most).toBeLessThanOrEqual(1)
    expect(least).toBeLessThan(0.85)
  })
})
