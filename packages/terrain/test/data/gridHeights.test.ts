import fc from 'fast-check'
import { MathUtils, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { GridHeights, type GridHeightsOptions } from '../../src/data/GridHeights'
import { degreesOf, earth, pageAt } from './tiles'

const WIDTH = 40
const HEIGHT = 30
const area = { width: WIDTH, height: HEIGHT, west: 10, east: 10.4, south: 47, north: 47.3 }
const step = 0.01

/** Height of smooth hills [m]. */
const hills = (longitude: number, latitude: number): number =>
  500 + 200 * Math.sin(40 * (longitude - 10)) * Math.cos(30 * (latitude - 47))
const longitudeOf = (column: number): number => area.west + (column + 0.5) * step
const latitudeOf = (row: number): number => area.north - (row + 0.5) * step

const values = Array.from({ length: WIDTH * HEIGHT }, (_, i) =>
  hills(longitudeOf(i % WIDTH), latitudeOf(Math.floor(i / WIDTH)))
)
const make = (options: Partial<GridHeightsOptions> = {}, numbers: ArrayLike<number> = values) =>
  new GridHeights(numbers, { ...area, ...options })
const grid = make({ outside: 100, fade: 5000 })
const sampleAt = (source: GridHeights, longitude: number, latitude: number) =>
  source.sampleAt(earth.geodeticToECEF({ longitude, latitude }), {
    height: 0,
    gradient: new Vector3()
  })

const anywhere = fc.tuple(
  fc.double({ min: 9.9, max: 10.5, noNaN: true }),
  fc.double({ min: 46.9, max: 47.4, noNaN: true })
)

it('knows the no-data value of 32-bit floats in all decimals that files have it in', () => {
  const lowest = -3.4028234663852886e38
  const numbers = Float32Array.from(values, (value, i) => (i % 7 === 0 ? lowest : value))
  for (const noData of [lowest, -3.40282346638529e38, -3.4028235e38, -3.40282347e38]) {
    const holed = make({ noData, outside: 500 }, numbers)
    expect(holed.lowest).toBeGreaterThan(0)
    expect(sampleAt(holed, longitudeOf(14), latitudeOf(7)).height).toBeGreaterThan(300)
  }
  const tenths = Float32Array.from(values, (value, i) => (i % 7 === 0 ? -9999.9 : value))
  expect(make({ noData: -9999.9, outside: 500 }, tenths).lowest).toBeGreaterThan(0)
})

describe('a grid', () => {
  it('goes through its numbers, and near the function between them', () => {
    for (const i of [0, 39, 612, 1199]) {
      const { height } = sampleAt(grid, longitudeOf(i % WIDTH), latitudeOf(Math.floor(i / WIDTH)))
      expect(height).toBeCloseTo(values[i], 3)
    }
    const inside = fc.tuple(
      fc.double({ min: 10.02, max: 10.38, noNaN: true }),
      fc.double({ min: 47.02, max: 47.28, noNaN: true })
    )
    fc.assert(
      fc.property(inside, ([longitude, latitude]) => {
        const { height } = sampleAt(grid, longitude, latitude)
        expect(Math.abs(height - hills(longitude, latitude))).toBeLessThan(2)
      })
    )
  })

  it('has the gradient of its heights, inside, beyond its edges and far away', () => {
    const way = 0.5
    // Slopes end at the grid's edges: there heights to both sides are no measure of one.
    const meter = MathUtils.RAD2DEG / 6.3e6
    const isNear = (value: number, edge: number, reach: number) => Math.abs(value - edge) < reach
    fc.assert(
      fc.property(anywhere, ([longitude, latitude]) => {
        fc.pre(![area.west, area.east].some(edge => isNear(longitude, edge, 1.5 * way * meter)))
        fc.pre(![area.south, area.north].some(edge => isNear(latitude, edge, way * meter)))
        const position = earth.geodeticToECEF({ longitude, latitude })
        const { gradient } = grid.sampleAt(position, { height: 0, gradient: new Vector3() })
        const frame = earth.eastNorthUpFrame(position)
        for (const axis of [new Vector3(1, 0, 0), new Vector3(0, 1, 0)]) {
          const direction = axis.transformDirection(frame)
          const [after, before] = [way, -way].map(by => {
            const place = earth.footPoint(position.clone().addScaledVector(direction, by))
            return grid.sampleAt(place, { height: 0, gradient: new Vector3() }).height
          })
          expect(Math.abs((after - before) / (2 * way) - gradient.dot(direction))).toBeLessThan(
            2e-3
          )
        }
      }),
      { numRuns: 300 }
    )
  })

  it('is within its bounds', () => {
    fc.assert(
      fc.property(anywhere, anywhere, ([a, b], [c, d]) => {
        const [first, second] = [sampleAt(grid, a, b).height, sampleAt(grid, c, d).height]
        expect(first).toBeGreaterThanOrEqual(grid.lowest)
        expect(first).toBeLessThanOrEqual(grid.highest)
        const distance = earth
          .geodeticToECEF({ longitude: a, latitude: b })
          .distanceTo(earth.geodeticToECEF({ longitude: c, latitude: d }))
        expect(Math.abs(first - second)).toBeLessThanOrEqual(grid.variation(distance) + 1e-6)
      }),
      { numRuns: 500 }
    )
  })

  it('goes on at its edge, and is level far outside', () => {
    expect(sampleAt(grid, 9.9999, 47.15).height).toBeCloseTo(
      sampleAt(grid, 10.0001, 47.15).height,
      0
    )
    expect(sampleAt(grid, 9.5, 47.15).height).toBe(100)
    expect(sampleAt(grid, -170, -30).height).toBe(100)
    expect(sampleAt(grid, 0, 90).height).toBe(100)
  })

  it('fills pages with its heights, and coarse ones with means', () => {
    const fine = pageAt(10.2, 47.15, 12)
    const heights = grid.loadHeights(fine)
    for (const [i, { longitude, latitude }] of degreesOf(fine).entries()) {
      expect(heights[i]).toBeCloseTo(sampleAt(grid, longitude, latitude).height, 2)
    }
    // As a terrain asks: between exact places others are linear.
    const whole = pageAt(10.2, 47.15, 12, 128)
    const many = grid.loadHeights(whole)
    for (const [i, { longitude, latitude }] of degreesOf(whole).entries()) {
      if (i % 37 !== 0) continue
      expect(Math.abs(many[i] - sampleAt(grid, longitude, latitude).height)).toBeLessThan(1e-3)
    }
    // Stripes of a cell each are gone from pages with steps of many cells.
    const stripes = make(
      { outside: 50 },
      values.map((_, i) => (i % 2 === 0 ? 0 : 100))
    )
    const coarse = pageAt(10.2, 47.15, 10)
    for (const height of stripes.loadHeights(coarse)) expect(Math.abs(height - 50)).toBeLessThan(1)
  })

  it('fills pages about its edges, wholly outside or not, with the heights that places have', () => {
    let level = 0
    for (const longitude of [9.86, 9.92, 9.98, 10.2, 10.42, 10.48, 10.54]) {
      for (const latitude of [46.9, 46.95, 46.98, 47.15, 47.32, 47.36, 47.4]) {
        const page = pageAt(longitude, latitude, 12)
        const heights = grid.loadHeights(page)
        if (heights.every(height => height === 100)) level++
        for (const [i, place] of degreesOf(page).entries()) {
          const { height } = sampleAt(grid, place.longitude, place.latitude)
          expect(Math.abs(heights[i] - height)).toBeLessThan(0.01)
        }
      }
    }
    expect(level).toBeGreaterThan(10)
    expect(level).toBeLessThan(40)
  })

  it('finds pages much finer than its numbers to a thousandth of their differences, within 1 mm about a walker', () => {
    const rough = values.map((_, i) => 500 + 60 * Math.sin(12.9898 * i * i))
    const rugged = make({}, rough)
    let most = 0
    for (const level of [12, 14, 16, 18, 20]) {
      const page = pageAt(10.2, 47.15, level, 132)
      const heights = rugged.loadHeights(page)
      let worst = 0
      for (const [i, { longitude, latitude }] of degreesOf(page).entries()) {
        if (i % 41 !== 0) continue
        const { height } = sampleAt(rugged, longitude, latitude)
        worst = Math.max(worst, Math.abs(heights[i] - height))
      }
      most = Math.max(most, worst)
      expect(worst).toBeLessThan(level < 18 ? 0.12 : 1e-3)
    }
    // Those of some page are interpolated.
    expect(most).toBeGreaterThan(1e-4)
  })

  it('takes what has no number from about it', () => {
    const holed = values.map((value, i) =>
      i % WIDTH > 10 && i % WIDTH < 16 ? -9999 : i === 700 ? NaN : value
    )
    const filled = make({ noData: -9999 }, holed)
    fc.assert(
      fc.property(anywhere, ([longitude, latitude]) => {
        const { height, gradient } = sampleAt(filled, longitude, latitude)
        expect(Number.isFinite(height) && Number.isFinite(gradient.length())).toBe(true)
        expect(height).toBeGreaterThan(-100)
      })
    )
    const none = make({ noData: 3, outside: 7 }, new Int16Array(WIDTH * HEIGHT).fill(3))
    expect(sampleAt(none, 10.2, 47.1).height).toBe(7)
  })

  it('lies across the antimeridian, and around the planet', () => {
    const across = make({ west: 179.8, east: 180.2 })
    expect(sampleAt(across, -179.9, 47.1).height).toBeCloseTo(sampleAt(grid, 10.3, 47.1).height, 3)
    const world = new GridHeights([1, 2, 3, 4, 5, 6, 7, 8], {
      width: 4,
      height: 2,
      west: -180,
      east: 180,
      south: -90,
      north: 90
    })
    expect(sampleAt(world, 180 - 1e-7, 10).height).toBeCloseTo(sampleAt(world, -180, 10).height, 4)
  })

  // 22 columns have a half, and that one has none.
  it.each([22, 24, 25])('has no seam in coarse pages around the planet of %d columns', width => {
    const height = 64
    const numbers = Array.from({ length: width * height }, (_, i) => 100 * ((i % width) % 7))
    const around = { west: -180, east: 180, south: -90, north: 90 }
    const world = new GridHeights(numbers, { width, height, ...around })
    const page = { face: 1, level: 0, x: 0, y: 0, side: 2, vertices: 5 }
    for (const spacing of [1e5, 7e5, 1.3e6, 5.3e6, 1e7]) {
      const heights = world.loadHeights({
        ...page,
        spacing,
        placeOf: (column, row) =>
          earth.geodeticToECEF({ longitude: 180 + (column - 0.5) * 1e-7, latitude: 20 * row })
      })
      expect(heights[0]).toBeCloseTo(heights[1], 3)
      expect(heights[2]).toBeCloseTo(heights[3], 3)
    }
  })
})

it.each<[string, () => unknown]>([
  ['GridHeights: values must be 1200 numbers, got 3', () => make({}, [1, 2, 3])],
  ['GridHeights: width must be a whole number ≥ 2', () => make({ width: 1 })],
  ['GridHeights: east must be in (west, west + 360]', () => make({ east: 9 })],
  ['GridHeights: south must be in [−90, 90)', () => make({ south: -91 })],
  ['GridHeights: north must be in (south, 90]', () => make({ north: 46 })],
  ['GridHeights: scale must be a finite number', () => make({ scale: NaN })],
  ['GridHeights: fade must be finite and ≥ 0', () => make({ fade: -1 })],
  ['GridHeights: ellipsoid must be', () => make({ ellipsoid: {} as never })],
  ["GridHeights: unknown option 'nodata'", () => make({ nodata: 1 } as never)]
])('%s', (message, call) => {
  expect(call).toThrow(message)
})
