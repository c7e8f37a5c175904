import { fromArrayBuffer, writeArrayBuffer } from 'geotiff'
import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import type { GridHeights } from '../../src/data/GridHeights'
import { heightsFromGeoTIFF, type GeoTIFFHeightsOptions } from '../../src/data/heightsFromGeoTIFF'
import { earth } from './tiles'

const WIDTH = 6
const HEIGHT = 4
const NONE = -32768
/** Heights of which each is another, but for a hole. */
const values = Float32Array.from({ length: WIDTH * HEIGHT }, (_, i) =>
  i === 9 ? NONE : 100 + 7 * i
)
const step = 0.01
const degrees = {
  width: WIDTH,
  height: HEIGHT,
  ModelPixelScale: [step, step, 0],
  ModelTiepoint: [0, 0, 0, 10, 47, 0],
  GTModelTypeGeoKey: 2,
  GTRasterTypeGeoKey: 1,
  GeographicTypeGeoKey: 4326,
  GDAL_NODATA: `${NONE}\0`
}
const metres = {
  width: WIDTH,
  height: HEIGHT,
  ModelPixelScale: [10, 10, 0],
  ModelTiepoint: [0, 0, 0, 400_000, 5_200_000, 0],
  GTModelTypeGeoKey: 1,
  GTRasterTypeGeoKey: 1,
  ProjectedCSTypeGeoKey: 32_632
}

/** Heights of a file, written and read by the package geotiff. */
async function heightsOf(
  metadata: Record<string, unknown>,
  options: GeoTIFFHeightsOptions = {}
): Promise<GridHeights> {
  const file = await fromArrayBuffer(writeArrayBuffer(values, { ...metadata }))
  return heightsFromGeoTIFF(await file.getImage(), options)
}

const heightAt = (source: GridHeights, position: Vector3): number =>
  source.sampleAt(position, { height: 0, gradient: new Vector3() }).height
const onEarth = (source: GridHeights, longitude: number, latitude: number): number =>
  heightAt(source, earth.geodeticToECEF({ longitude, latitude }))

describe('heights of a GeoTIFF', () => {
  it('lie at the centres of its pixels, and holes are filled', async () => {
    const heights = await heightsOf(degrees, { attribution: 'Someone' })
    expect(heights.size).toEqual({ width: WIDTH, height: HEIGHT })
    expect(heights.attribution).toBe('Someone')
    for (const i of [0, 5, 14, 23]) {
      const [column, row] = [i % WIDTH, Math.floor(i / WIDTH)]
      const height = onEarth(heights, 10 + (column + 0.5) * step, 47 - (row + 0.5) * step)
      expect(height).toBeCloseTo(values[i], 3)
    }
    expect(onEarth(heights, 10 + 3.5 * step, 47 - 1.5 * step)).toBeGreaterThan(100)
  })

  it('lie at points if the file says so', async () => {
    const heights = await heightsOf({ ...degrees, GTRasterTypeGeoKey: 2 })
    expect(onEarth(heights, 10, 47)).toBeCloseTo(values[0], 3)
    expect(onEarth(heights, 10 + 2 * step, 47 - 3 * step)).toBeCloseTo(values[20], 3)
  })

  it('are those of a window', async () => {
    const heights = await heightsOf(degrees, { window: [2, 1, 5, 4], outside: 5, fade: 1 })
    expect(heights.size).toEqual({ width: 3, height: 3 })
    expect(onEarth(heights, 10 + 4.5 * step, 47 - 3.5 * step)).toBeCloseTo(values[22], 3)
    expect(onEarth(heights, 10 + 0.5 * step, 47 - 0.5 * step)).toBe(5)
  })

  it('in metres lie about the origin of a flat world', async () => {
    const about = await heightsOf(metres)
    // North is −Z.
    expect(heightAt(about, new Vector3(-25, 0, -15))).toBeCloseTo(values[0], 3)
    const at = await heightsOf(metres, { origin: [400_000, 5_200_000] })
    expect(heightAt(at, new Vector3(35, 0, 25))).toBeCloseTo(values[15], 3)
  })

  it('in feet, upward or along the ground, become metres', async () => {
    const heights = await heightsOf({ ...degrees, VerticalUnitsGeoKey: 9002 })
    expect(onEarth(heights, 10 + 0.5 * step, 47 - 0.5 * step)).toBeCloseTo(30.48, 3)
    const wide = await heightsOf({ ...metres, ProjLinearUnitsGeoKey: 9002 })
    expect(heightAt(wide, new Vector3(-25 * 0.3048, 0, -15 * 0.3048))).toBeCloseTo(values[0], 3)
  })
})

it.each<[string, Record<string, unknown>, GeoTIFFHeightsOptions]>([
  ["heightsFromGeoTIFF: unknown option 'size'", degrees, { size: 3 } as never],
  [
    'heightsFromGeoTIFF: window must be whole pixels of the file',
    degrees,
    { window: [0, 0, 7, 4] }
  ],
  [
    'heightsFromGeoTIFF: window must be whole pixels of the file',
    degrees,
    { window: [3, 0, 4, 4] }
  ],
  ['heightsFromGeoTIFF: origin must be two finite numbers', metres, { origin: [NaN, 0] }],
  [
    'heightsFromGeoTIFF: image must have longitude and latitude, or metres',
    { ...degrees, GTModelTypeGeoKey: 3 },
    {}
  ],
  [
    'heightsFromGeoTIFF: image must be in degrees, unit 9102, got 9101',
    { ...degrees, GeogAngularUnitsGeoKey: 9101 },
    {}
  ],
  [
    'heightsFromGeoTIFF: image must be in metres or feet, got 9036',
    { ...metres, ProjLinearUnitsGeoKey: 9036 },
    {}
  ],
  ['GridHeights: fade must be finite and ≥ 0', degrees, { fade: -1 }]
])('%s', async (message, metadata, options) => {
  await expect(heightsOf(metadata, options)).rejects.toThrow(message)
})

it('refuses a turned image', async () => {
  const file = await fromArrayBuffer(writeArrayBuffer(values, { ...degrees }))
  const image = await file.getImage()
  // Of pixels turned by 30°, a box is larger than they are: the writer makes no such files.
  const [west, south] = image.getBoundingBox()
  const [c, s] = [step * Math.cos(Math.PI / 6), step * Math.sin(Math.PI / 6)]
  const [wide, tall] = [c * WIDTH + s * HEIGHT, s * WIDTH + c * HEIGHT]
  image.getBoundingBox = () => [west, south, west + wide, south + tall]
  await expect(heightsFromGeoTIFF(image)).rejects.toThrow('image must not be turned')
})
