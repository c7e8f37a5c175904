import { Ellipsoid } from '@welkin/geo'
import { Vector3 } from 'three'
import type { Pixels } from '../../src/data/loadPixels'
import type { PageRequest } from '../../src/pages/PageSource'
import { cubeToEllipsoid, faceAxes } from '../../src/tiles/cpu/cubeSphere'

export const earth = Ellipsoid.WGS84

/** Request for a page, as a terrain asks: a square of the cube, and one step beyond its edges. */
export function pageOf(face: number, level: number, x: number, y: number, steps = 8): PageRequest {
  const extent = 2 ** -level
  const { outward, first, second } = faceAxes(face)
  return {
    face,
    level,
    x,
    y,
    side: steps + 3,
    vertices: 5,
    spacing: (2 * extent * earth.maximumRadius) / steps,
    placeOf(column, row, target) {
      const across = x + ((2 * (column - 1)) / steps - 1) * extent
      const along = y + ((2 * (row - 1)) / steps - 1) * extent
      target.copy(outward).addScaledVector(first, across).addScaledVector(second, along)
      return cubeToEllipsoid(target, earth.radii, target)
    }
  }
}

/** Page of a level that has a place [°]. */
export function pageAt(longitude: number, latitude: number, level: number, steps = 8): PageRequest {
  const cube = earth.geodeticToECEF({ longitude, latitude }).divide(earth.radii)
  const { x, y, z } = cube
  const longest = Math.max(Math.abs(x), Math.abs(y), Math.abs(z))
  const axis = [x, y, z].findIndex(part => Math.abs(part) === longest)
  const face = 2 * axis + Number(cube.getComponent(axis) < 0)
  const { first, second } = faceAxes(face)
  cube.divideScalar(longest)
  const extent = 2 ** -level
  const middle = (part: number): number =>
    (2 * Math.floor((part + 1) / 2 / extent) + 1) * extent - 1
  return pageOf(face, level, middle(cube.dot(first)), middle(cube.dot(second)), steps)
}

/** Height of procedural hills at a place [°], smooth enough for the pixels of level 4 [m]. */
export const hills = (longitude: number, latitude: number): number =>
  1000 * Math.sin((6 * longitude * Math.PI) / 180) * Math.cos((5 * latitude * Math.PI) / 180) + 1500

/** Pixels of a Terrarium tile of a function. */
export function terrariumTile(
  z: number,
  x: number,
  y: number,
  heightOf = hills,
  size = 64
): Pixels {
  const data = new Uint8ClampedArray(4 * size * size)
  const scale = size * 2 ** z
  for (let j = 0; j < size; j++) {
    for (let i = 0; i < size; i++) {
      const longitude = ((x * size + i + 0.5) / scale) * 360 - 180
      const row = (y * size + j + 0.5) / scale
      const latitude = (Math.atan(Math.sinh(Math.PI * (1 - 2 * row))) * 180) / Math.PI
      const value = heightOf(longitude, latitude) + 32_768
      data.set(
        [Math.floor(value / 256), Math.floor(value) % 256, Math.floor((value % 1) * 256), 255],
        4 * (j * size + i)
      )
    }
  }
  return { width: size, height: size, data }
}

/** Level, column and row of an address `z/x/y`. */
export const partsOf = (url: string): [number, number, number] =>
  url.split('/').map(Number) as [number, number, number]

/** Places of a page as degrees. */
export function degreesOf({
  side,
  placeOf
}: PageRequest): { longitude: number; latitude: number }[] {
  const position = new Vector3()
  return Array.from({ length: side * side }, (_, i) =>
    earth.ecefToGeodetic(placeOf(i % side, Math.floor(i / side), position)).clone()
  )
}
