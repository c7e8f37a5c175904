import { BufferGeometry, Float32BufferAttribute } from 'three'
import {
  float,
  fract,
  hash,
  instanceIndex,
  mix,
  normalGeometry,
  positionGeometry,
  positionView,
  smoothstep,
  step,
  vec3
} from 'three/tsl'
import type { Node } from 'three/webgpu'

/** Half width of a roof to its eaves, and half length to its verges, over those of the house, which are ½; thickness. */
const EAVES = 0.61
const VERGE = 0.57
const THICK = 0.07

type Point = readonly [number, number, number]

/** A gabled roof with eaves over the unit square, of unit height, and the gables below it. */
export function roof(): BufferGeometry {
  const points: Point[] = []
  const quad = (a: Point, b: Point, c: Point, d: Point): void => void points.push(a, b, c, a, c, d)
  const end = 1 - 2 * EAVES // height of the eaves
  for (const side of [1, -1]) {
    const at = (x: number, y: number, z: number): Point => [side * x, y, side * z]
    const [top, foot] = [1 + THICK, end + THICK]
    quad(at(0, top, VERGE), at(EAVES, foot, VERGE), at(EAVES, foot, -VERGE), at(0, top, -VERGE))
    quad(at(0, 1, -VERGE), at(EAVES, end, -VERGE), at(EAVES, end, VERGE), at(0, 1, VERGE))
    quad(
      at(EAVES, foot, VERGE),
      at(EAVES, end, VERGE),
      at(EAVES, end, -VERGE),
      at(EAVES, foot, -VERGE)
    )
    quad(at(0, top, VERGE), at(0, 1, VERGE), at(EAVES, end, VERGE), at(EAVES, foot, VERGE))
    quad(at(0, top, -VERGE), at(EAVES, foot, -VERGE), at(EAVES, end, -VERGE), at(0, 1, -VERGE))
    points.push(at(-0.5, 0, 0.5), at(0.5, 0, 0.5), at(0, 1, 0.5))
  }
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new Float32BufferAttribute(points.flat(), 3))
  geometry.computeVertexNormals()
  return geometry
}

/** Colours of tiles: red, brown and grey, linear sRGB. */
const TILES = [
  [0.105, 0.043, 0.029],
  [0.07, 0.042, 0.03],
  [0.062, 0.058, 0.056]
] as const

/**
 * Colour of a {@link roof}: rows of tiles, some darker, as long as they are wider than pixels; boards on gables, and below and
 * beside the tiles.
 */
export function roofColor(): Node<'vec3'> {
  const house = float(instanceIndex)
  const row = positionGeometry.y.mul(16)
  const tile = positionGeometry.z.mul(28).add(step(1, row.mod(2)).mul(0.5))
  const distance = positionView.z.negate()
  const isNear = smoothstep(220, 60, distance)
  const aged = hash(row.floor().mul(61).add(tile.floor()).add(house.mul(17)).add(900))
  const shade = step(0.14, fract(row)).mul(0.25).add(0.75).mul(aged.mul(0.35).add(0.8))
  const kind = hash(house.mul(7).add(3))
  const [red, brown, grey] = TILES.map(color => vec3(...color))
  const tiles = mix(mix(red, brown, step(0.5, kind)), grey, step(0.8, kind))
  const joint = step(0.14, fract(positionGeometry.x.mul(34)))
    .mul(0.35)
    .add(0.65)
  const boards = vec3(0.12, 0.08, 0.055).mul(mix(float(0.94), joint, smoothstep(160, 60, distance)))
  const isTiled = step(0.1, normalGeometry.y)
  return mix(boards, tiles.mul(mix(float(0.87), shade, isNear)), isTiled)
}
