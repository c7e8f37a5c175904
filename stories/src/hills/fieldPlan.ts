import { DataTexture, MathUtils, NearestFilter, RepeatWrapping } from 'three'
import { hashed } from '../terrain/vegetation/valueNoise'

export type Color = readonly [number, number, number]

/** Width and length of a field [m], and the angle of its rows from the x axis. */
export const FIELD = [95, 210] as const
export const [COS, SIN] = [Math.cos(0.5), Math.sin(0.5)]

/** Place of the origin in its field, in fields: no camera stands on a hedge. */
export const ORIGIN = [0.4, 0.3] as const
/** Shift of a column of fields along it, in fields. */
export const SHIFT = 0.618

/** Bends of the edges along fields and across them: their height and length [m]. */
export const BENDS = [
  [26, 410],
  [34, 530]
] as const

/** Grass of meadows, dry blades in it, and ground below trees, linear sRGB. */
export const GRASS: Color = [0.13, 0.172, 0.051]
export const STRAW: Color = [0.24, 0.205, 0.095]
export const FOREST: Color = [0.026, 0.042, 0.019]

/** Crops of fields, up to a chance: grass, young and ripe corn, hay, earth, and then woods. */
const CROPS: readonly (readonly [chance: number, color: Color])[] = [
  [0.46, GRASS],
  [0.61, [0.062, 0.118, 0.03]],
  [0.74, [0.29, 0.235, 0.11]],
  [0.87, [0.175, 0.18, 0.072]],
  [0.945, [0.17, 0.132, 0.092]],
  [1, FOREST]
]

/** Mean colour of fields. */
export const MEAN = [0, 1, 2].map(i =>
  CROPS.reduce((sum, [to, color], n) => sum + color[i] * (to - (CROPS[n - 1]?.[0] ?? 0)), 0)
) as unknown as Color

/** Distance from the origin within which there is no wood [m]. */
const OPEN = 450

/** Fields along an edge of their texture, after which they repeat. */
export const PLANNED = 128
/** Colour of a texel of 1. */
export const BRIGHTEST = 0.4

/** Ground of a place in its field: `even` counts fields along their column, without its shift [m]. */
export function placeInFields(across: number, even: number): [x: number, z: number] {
  let [u, v] = [(across - ORIGIN[0]) * FIELD[0], (even - ORIGIN[1]) * FIELD[1]]
  const [straightU, straightV] = [u, v]
  for (let i = 0; i < 4; i++) {
    u = straightU - BENDS[0][0] * Math.sin(v / BENDS[0][1])
    v = straightV - BENDS[1][0] * Math.sin(u / BENDS[1][1])
  }
  return [COS * u - SIN * v, SIN * u + COS * v]
}

/** Index in `CROPS` of what a field grows. */
function cropOf(column: number, row: number): number {
  if (column === 0 && row === 0) return 0
  const chance = hashed(column, row, 3)
  const crop = CROPS.findIndex(([to]) => chance < to)
  if (crop < CROPS.length - 1) return crop
  const [x, z] = placeInFields(column + 0.5, row + 0.5 - SHIFT * column)
  return Math.hypot(x, z) < OPEN ? 0 : crop
}

/** True for a field of trees. */
export const isWood = (column: number, row: number): boolean =>
  cropOf(column, row) === CROPS.length - 1

/** Colours of fields over `BRIGHTEST`, by column and row, and 1 in alpha where they are sown. */
export function createFieldTexture(): DataTexture {
  const bytes = new Uint8Array(4 * PLANNED ** 2)
  for (let i = 0; i < PLANNED ** 2; i++) {
    const [column, row] = [i % PLANNED, Math.floor(i / PLANNED)].map(n =>
      n < PLANNED / 2 ? n : n - PLANNED
    )
    const brightness = 0.85 + 0.3 * hashed(column, row, 4)
    const crop = cropOf(column, row)
    const [, color] = CROPS[crop]
    const isSown = crop > 0 && crop < CROPS.length - 1
    const texel = color.map(part => (255 * part * brightness) / BRIGHTEST)
    bytes.set(
      [...texel.map(part => MathUtils.clamp(Math.round(part), 0, 255)), isSown ? 255 : 0],
      4 * i
    )
  }
  const result = new DataTexture(bytes, PLANNED, PLANNED)
  result.wrapS = result.wrapT = RepeatWrapping
  result.magFilter = result.minFilter = NearestFilter
  result.needsUpdate = true
  return result
}
