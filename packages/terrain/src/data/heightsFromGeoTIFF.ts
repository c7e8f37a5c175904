import { checkOptions, fail } from '@welkin/geo'
import { GridHeights, type GridHeightsOptions } from './GridHeights'

/** Part of a `GeoTIFFImage` of the package geotiff that is used; others may stand in for it. */
export interface GeoTIFFRaster {
  /** Width [pixels]. */
  getWidth(): number
  /** Height [pixels]. */
  getHeight(): number
  /** Least x and y, largest x and y, in units of the file. */
  getBoundingBox(): number[]
  /** Width and height of a pixel, of any sign, in units of the file. */
  getResolution(): number[]
  /** Value of missing heights, by GDAL's tag; null for none. */
  getGDALNoData(): number | null
  /** Values of the file's GeoKeys by name. */
  getGeoKeys(): Partial<Record<string, unknown>> | null
  /** Values of some channels in a window (left, top, right, bottom), row by row from the top. */
  readRasters(options: {
    samples: number[]
    window: number[]
    interleave: false
    signal?: AbortSignal
  }): Promise<ArrayLike<ArrayLike<number>>>
}

/** Options of {@link heightsFromGeoTIFF}: what a grid needs and a file does not tell. */
export interface GeoTIFFHeightsOptions extends Pick<
  GridHeightsOptions,
  'scale' | 'outside' | 'fade' | 'ellipsoid' | 'attribution'
> {
  /** Value of missing heights, default the file's own. */
  noData?: number
  /** Part that is read, default all: left, top, right and bottom in whole pixels from the north-west corner. */
  window?: [left: number, top: number, right: number, bottom: number]
  /**
   * Easting and northing of the world's origin, for a flat world and a file of metres; default the middle of what is read [m].
   */
  origin?: [easting: number, northing: number]
  /** Signal that gives up reading when it is aborted. */
  signal?: AbortSignal
}

const OPTIONS = [
  'scale',
  'outside',
  'fade',
  'ellipsoid',
  'attribution',
  'noData',
  'window',
  'origin',
  'signal'
] as const

/** Values of `GTModelTypeGeoKey`, `GTRasterTypeGeoKey` and of keys for units that are understood: OGC 19-008r4, annex B. */
const PROJECTED = 1
const GEOGRAPHIC = 2
const PIXEL_IS_POINT = 2
const DEGREE = 9102
const METRES: Partial<Record<number, number>> = { 9001: 1, 9002: 0.3048, 9003: 1200 / 3937 }

/**
 * Heights of one GeoTIFF, which the package geotiff, or another of the same interface, has opened. It is yours to install and to import.
 *
 * ```ts
 * import { fromUrl } from 'geotiff'
 *
 * const file = await fromUrl('heights.tif')
 * const heights = await heightsFromGeoTIFF(await file.getImage(), { outside: 300 })
 * scene.add(new Terrain(atmosphere, heights))
 * ```
 *
 * A file of longitude and latitude lies on the planet; one of metres or feet along east and north, such as of UTM, is for a flat world, about
 * `origin`. Pixels may stand for areas or points. Heights in feet become metres if the file says so: that is the default of `scale`.
 *
 * @param image - First image of the file, north up; its first channel is read.
 * @throws If the image is turned, says nothing of where it is or has other units, or an option is unknown or out of its range.
 * @see OGC 19-008r4, "OGC GeoTIFF Standard", https://docs.ogc.org/is/19-008r4/19-008r4.html
 */
export async function heightsFromGeoTIFF(
  image: GeoTIFFRaster,
  options: GeoTIFFHeightsOptions = {}
): Promise<GridHeights> {
  const where = 'heightsFromGeoTIFF'
  checkOptions(where, options, ...OPTIONS)
  const [columns, rows] = [image.getWidth(), image.getHeight()]
  const { window: part = [0, 0, columns, rows], origin, signal, ...rest } = options
  const [left, top, right, bottom] = part
  const width = right - left
  const height = bottom - top
  const isWithin = left >= 0 && top >= 0 && right <= columns && bottom <= rows
  if (!(part.every(Number.isInteger) && isWithin && width >= 2 && height >= 2)) {
    fail(where, 'window must be whole pixels of the file', part)
  }
  if (origin !== undefined && !(origin.length === 2 && origin.every(Number.isFinite))) {
    fail(where, 'origin must be two finite numbers', origin)
  }
  const keys = image.getGeoKeys() ?? {}
  const unit = unitOf(where, keys)
  const edges = edgesOf(where, image, keys)
  const along = (from: number, to: number, share: number): number => from + (to - from) * share
  const area = {
    west: along(edges.west, edges.east, left / columns) * unit,
    east: along(edges.west, edges.east, right / columns) * unit,
    south: along(edges.north, edges.south, bottom / rows) * unit,
    north: along(edges.north, edges.south, top / rows) * unit
  }
  const isFlat = keys.GTModelTypeGeoKey === PROJECTED
  if (isFlat) {
    const [x, y] = origin ?? [(area.west + area.east) / 2, (area.south + area.north) / 2]
    area.west -= x
    area.east -= x
    area.south -= y
    area.north -= y
  }
  const [values] = Array.from(
    await image.readRasters({
      samples: [0],
      window: [...part],
      interleave: false,
      ...(signal === undefined ? {} : { signal })
    })
  )
  const vertical = METRES[Number(keys.VerticalUnitsGeoKey)]
  return new GridHeights(values, {
    scale: vertical ?? 1,
    noData: image.getGDALNoData() ?? NaN,
    ...rest,
    ...area,
    width,
    height,
    units: isFlat ? 'meters' : 'degrees'
  })
}

/**
 * Degrees or metres per unit of the file.
 *
 * @throws If it has others.
 */
function unitOf(where: string, keys: Partial<Record<string, unknown>>): number {
  const model = keys.GTModelTypeGeoKey
  if (model === GEOGRAPHIC) {
    const unit = keys.GeogAngularUnitsGeoKey ?? DEGREE
    if (unit !== DEGREE) fail(where, 'image must be in degrees, unit 9102', unit)
    return 1
  }
  if (model !== PROJECTED) {
    fail(where, 'image must have longitude and latitude, or metres, for axes; GTModelType', model)
  }
  const unit = keys.ProjLinearUnitsGeoKey ?? 9001
  return METRES[Number(unit)] ?? fail(where, 'image must be in metres or feet', unit)
}

/** Outer edges of the outermost pixels, in units of the file. */
function edgesOf(where: string, image: GeoTIFFRaster, keys: Partial<Record<string, unknown>>) {
  const [west, south, east, north] = image.getBoundingBox()
  if (!(east > west && north > south)) {
    fail(where, 'image must have a bounding box', [west, south, east, north])
  }
  const [pixelX, pixelY] = image.getResolution()
  const sides = [(east - west) / image.getWidth(), (north - south) / image.getHeight()]
  if (
    Math.abs(sides[0] / Math.abs(pixelX) - 1) > 1e-6 ||
    Math.abs(sides[1] / Math.abs(pixelY) - 1) > 1e-6
  ) {
    fail(where, 'image must not be turned; pixels in its bounding box', sides)
  }
  // Where pixels are points, the box begins at the first and ends one step after the last.
  const isPoint = keys.GTRasterTypeGeoKey === PIXEL_IS_POINT
  const x = isPoint ? (east - west) / image.getWidth() / 2 : 0
  const y = isPoint ? (north - south) / image.getHeight() / 2 : 0
  return { west: west - x, east: east - x, south: south + y, north: north + y }
}
