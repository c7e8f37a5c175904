import type { Elevation } from './elevation.ts'

const SEMI_MAJOR = 6378137
const ECCENTRICITY_SQUARED = 0.00669437999014

export type Vec3 = [number, number, number]

export function toECEF(latitude: number, longitude: number, height: number): Vec3 {
  const phi = (latitude * Math.PI) / 180
  const lambda = (longitude * Math.PI) / 180
  const normalRadius = SEMI_MAJOR / Math.sqrt(1 - ECCENTRICITY_SQUARED * Math.sin(phi) ** 2)
  return [
    (normalRadius + height) * Math.cos(phi) * Math.cos(lambda),
    (normalRadius + height) * Math.cos(phi) * Math.sin(lambda),
    (normalRadius * (1 - ECCENTRICITY_SQUARED) + height) * Math.sin(phi)
  ]
}

/** Rise per metre towards the east and the north, over two samples on either side. */
export function gradient(
  grid: Elevation,
  row: number,
  column: number
): [east: number, north: number] {
  const phi = (grid.latitude(row) * Math.PI) / 180
  const w = Math.sqrt(1 - ECCENTRICITY_SQUARED * Math.sin(phi) ** 2)
  const metresPerRow =
    ((grid.stepLatitude * Math.PI) / 180) * ((SEMI_MAJOR * (1 - ECCENTRICITY_SQUARED)) / w ** 3)
  const metresPerColumn = ((grid.stepLongitude * Math.PI) / 180) * (SEMI_MAJOR / w) * Math.cos(phi)
  return [
    (grid.at(row, column + 1) - grid.at(row, column - 1)) / (2 * metresPerColumn),
    (grid.at(row - 1, column) - grid.at(row + 1, column)) / (2 * metresPerRow)
  ]
}

export function localFrame(
  latitude: number,
  longitude: number
): { east: Vec3; north: Vec3; up: Vec3 } {
  const phi = (latitude * Math.PI) / 180
  const lambda = (longitude * Math.PI) / 180
  const [sinPhi, cosPhi, sinLambda, cosLambda] = [
    Math.sin(phi),
    Math.cos(phi),
    Math.sin(lambda),
    Math.cos(lambda)
  ]
  return {
    east: [-sinLambda, cosLambda, 0],
    north: [-sinPhi * cosLambda, -sinPhi * sinLambda, cosPhi],
    up: [cosPhi * cosLambda, cosPhi * sinLambda, sinPhi]
  }
}
