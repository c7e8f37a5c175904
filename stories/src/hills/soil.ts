import {
  attribute,
  floor,
  fract,
  fwidth,
  mix,
  normalWorld,
  positionWorld,
  sin,
  smoothstep,
  texture,
  vec2,
  vec3
} from 'three/tsl'
import { MeshStandardNodeMaterial, type Node } from 'three/webgpu'
import { createNoiseTexture } from '../globe/detailNoise'

type Color = readonly [number, number, number]

/** Colours of low ground and of heights, linear sRGB; how much each varies, and if low ground has fields and forests. */
export interface Soil {
  low: Color
  high: Color
  variation: number
  isFarmed?: true
}

export const meadow: Soil = {
  low: [0.13, 0.16, 0.055],
  high: [0.22, 0.19, 0.15],
  variation: 0.25,
  isFarmed: true
}
export const snow: Soil = { low: [0.85, 0.86, 0.87], high: [0.8, 0.81, 0.83], variation: 0.05 }
export const redDust: Soil = { low: [0.3, 0.13, 0.06], high: [0.22, 0.11, 0.06], variation: 0.3 }

/** Colours of fields, linear sRGB: grass, young and ripe corn, hay, earth. */
const CROPS: readonly Color[] = [
  [0.17, 0.2, 0.068],
  [0.09, 0.155, 0.042],
  [0.32, 0.26, 0.12],
  [0.23, 0.23, 0.095],
  [0.19, 0.15, 0.105]
]
const FOREST: Color = [0.026, 0.042, 0.019]
const HEDGE: Color = [0.045, 0.065, 0.024]
/** Dry blades among the green ones, and the shade between tufts. */
const STRAW: Color = [0.3, 0.25, 0.11]
const BETWEEN: Color = [0.034, 0.04, 0.018]

/** Width and length of a field [m], and the angle of its rows from the x axis. */
const FIELD = [95, 210] as const
const [COS, SIN] = [Math.cos(0.5), Math.sin(0.5)]
/** Half width of hedges [m]. */
const HALF_HEDGE = 1.6

/** Place of the origin in its field, in fields: no camera stands on a hedge. */
const ORIGIN = [0.4, 0.3] as const
/** Shift of a column of fields along it, in fields. */
const SHIFT = 0.618
/** Swaths per metre in which a field was mown or sown. */
const SWATHS = 1 / 3.1

/** Distance of a place from the nearest edge of its field [m]. */
export function hedgeDistance(x: number, z: number): number {
  const [u, v] = [COS * x + SIN * z, COS * z - SIN * x]
  const across = (u + 26 * Math.sin(v / 410)) / FIELD[0] + ORIGIN[0]
  const along = (v + 34 * Math.sin(u / 530)) / FIELD[1] + ORIGIN[1] + SHIFT * Math.floor(across)
  const [right, far] = [across - Math.floor(across), along - Math.floor(along)]
  return Math.min(Math.min(right, 1 - right) * FIELD[0], Math.min(far, 1 - far) * FIELD[1])
}

/** Patchwork of fields with hedges between them; of fields smaller than pixels, their mean. */
function fields(place: Node<'vec2'>, grass: Node<'vec3'>): Node<'vec3'> {
  const u = place.dot(vec2(COS, SIN)).toConst()
  const v = place.dot(vec2(-SIN, COS)).toConst()
  const across = u
    .add(sin(v.div(410)).mul(26))
    .div(FIELD[0])
    .add(ORIGIN[0])
    .toConst()
  const column = floor(across).toConst()
  const even = v
    .add(sin(u.div(530)).mul(34))
    .div(FIELD[1])
    .add(ORIGIN[1])
    .toConst()
  const along = even.add(column.mul(SHIFT)).toConst()
  const row = floor(along).toConst()
  const chance = fract(sin(column.mul(12.99).add(row.mul(78.23)).add(2.08)).mul(437.58)).mul(
    CROPS.length
  )
  let crop: Node<'vec3'> = grass
  for (const [i, color] of CROPS.entries()) {
    if (i > 0) crop = chance.greaterThan(i).select(vec3(...color), crop)
  }
  const pixel = vec2(fwidth(across).mul(FIELD[0]), fwidth(even).mul(FIELD[1])).toConst()
  const inField = vec2(fract(across), fract(along))
  const edge = inField
    .min(inField.oneMinus())
    .mul(vec2(...FIELD))
    .toConst()
  const side = smoothstep(vec2(HALF_HEDGE).sub(pixel), vec2(HALF_HEDGE).add(pixel), edge).oneMinus()
  const thin = pixel
    .div(2 * HALF_HEDGE)
    .max(1)
    .reciprocal()
  const hedge = side.mul(thin).toConst()
  const seen = smoothstep(vec2(...FIELD), vec2(...FIELD).mul(0.25), pixel).toConst()
  const mean = vec3(
    ...(CROPS[0].map((_, i) => CROPS.reduce((s, c) => s + c[i] / CROPS.length, 0)) as [
      number,
      number,
      number
    ])
  )
  const swaths = sin(u.mul(2 * Math.PI * SWATHS))
    .mul(smoothstep(0.4, 0.15, pixel.x.mul(SWATHS)))
    .mul(0.07)
  const mixed = mix(mean, crop.mul(swaths.add(1)), seen.x.mul(seen.y))
  return mix(mixed, vec3(...HEDGE), hedge.x.max(hedge.y))
}

/**
 * Blades and tufts of what grows, which fade as pixels average them: straw here and there, shade between.
 *
 * @param noise - Noise about ±1 by its period [m].
 */
function grown(color: Node<'vec3'>, noise: (period: number) => Node<'float'>): Node<'vec3'> {
  // Sums of periods without a common multiple: one alone shows as rows.
  const blades = noise(1.13).add(noise(1.73)).add(noise(0.47).mul(0.4)).mul(0.5).toConst()
  const tufts = noise(4.3).add(noise(11.9)).mul(0.6).add(blades.mul(0.6)).toConst()
  const dry = smoothstep(0.2, 0.9, blades.sub(noise(17)))
  const low = smoothstep(-0.3, -1.1, tufts)
  const lit = color.mul(blades.mul(0.8).add(tufts.mul(0.2)).add(1).max(0.3))
  return mix(mix(lit, vec3(...STRAW), dry.mul(0.4)), vec3(...BETWEEN), low.mul(0.5))
}

/**
 * Material of ground with an attribute `height` [m]: fields and woods below, rock above, all with grain down to some
 * decimetres.
 */
export function soilMaterial({ low, high, variation, isFarmed }: Soil): MeshStandardNodeMaterial {
  const material = new MeshStandardNodeMaterial({ roughness: 1 })
  const picture = createNoiseTexture()
  // Ground before one's feet is seen at a grazing angle.
  picture.anisotropy = 16
  material.addEventListener('dispose', () => picture.dispose())
  const place = positionWorld.xz
  // Five octaves from an eighth of the period on, about ±1; no two periods have a common multiple, and each is turned.
  const noise = (period: number): Node<'float'> => {
    const [cos, sine] = [Math.cos(period), Math.sin(period)].map(t => t / period)
    const turned = vec2(place.dot(vec2(cos, sine)), place.dot(vec2(-sine, cos)))
    return texture(picture, turned).r.sub(0.5).mul(2)
  }
  const broad = noise(2930).add(noise(11_700)).toVar()
  const fine = noise(1.7).add(noise(9.1)).add(noise(47)).add(noise(410).mul(0.8)).toVar()
  const height = attribute<'float'>('height', 'float').add(broad.mul(90)).toVar()
  const lit = fine.mul(variation).mul(0.8).add(1)
  let color: Node<'vec3'> = vec3(...low)
  if (isFarmed) {
    const grass = mix(vec3(...CROPS[0]), vec3(...low), broad.add(0.5).clamp())
    color = mix(fields(place, grass), vec3(...low), smoothstep(25, 90, height))
    const wooded = broad.add(noise(730).mul(0.5)).add(smoothstep(15, 220, height).mul(0.75))
    const woods = smoothstep(0.5, 0.68, wooded).mul(smoothstep(20, 45, height))
    color = mix(color, vec3(...FOREST).mul(fine.mul(0.4).add(1)), woods)
  }
  if (isFarmed) color = grown(color, noise)
  color = mix(color, vec3(...high), smoothstep(480, 1000, height))
  // Cliffs.
  if (isFarmed) color = mix(color, vec3(...high), smoothstep(0.2, 0.34, normalWorld.y.oneMinus()))
  material.colorNode = color.mul(lit.max(0.3))
  return material
}
