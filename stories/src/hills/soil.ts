import {
  attribute,
  floor,
  fract,
  fwidth,
  int,
  mix,
  normalWorldGeometry,
  positionWorld,
  sin,
  smoothstep,
  texture,
  transformNormalToView,
  vec2,
  vec3
} from 'three/tsl'
import type { DataTexture } from 'three'
import { MeshStandardNodeMaterial, type Node } from 'three/webgpu'
import { createNoiseTexture } from '../globe/detailNoise'
import {
  BENDS,
  BRIGHTEST,
  COS,
  createFieldTexture,
  FIELD,
  FOREST,
  MEAN,
  ORIGIN,
  PLANNED,
  SHIFT,
  SIN,
  STRAW,
  type Color
} from './fieldPlan'

/** Colours of low ground and of heights, linear sRGB; how much each varies, and if low ground has fields and forests. */
export interface Soil {
  low: Color
  high: Color
  variation: number
  isFarmed?: true
  /** Snow lies on the fields. */
  isSnowy?: true
}

export const meadow: Soil = {
  low: [0.122, 0.148, 0.05],
  high: [0.2, 0.17, 0.125],
  variation: 0.17,
  isFarmed: true
}
export const snow: Soil = {
  low: [0.85, 0.86, 0.87],
  high: [0.8, 0.81, 0.83],
  variation: 0.05,
  isFarmed: true,
  isSnowy: true
}
export const redDust: Soil = { low: [0.3, 0.13, 0.06], high: [0.22, 0.11, 0.06], variation: 0.3 }

/** Woods of leaves on the hills, between those of needles, and heath. */
const LEAFY: Color = [0.043, 0.064, 0.022]
const HEATH: Color = [0.15, 0.132, 0.07]
const VERGE: Color = [0.05, 0.068, 0.024]
/** Shade between tufts. */
const BETWEEN: Color = [0.034, 0.04, 0.018]

/** Half width of the ground below hedges [m], and distances between which it is all that is left of them. */
const HALF_VERGE = 1.3
const HEDGES_GO = [1100, 1500] as const

/** Swaths per metre in which fields are mown or sown. */
const SWATHS = 1 / 3.1

/** Noise of the relief that is finer than the grid, and of drifts of snow: period, way between samples, and height [m]. */
const RELIEF = { period: 2300, step: 26, height: 52 }
const DRIFTS = { period: 29, step: 0.8, height: 0.22 }

type Noise = (period: number, place?: Node<'vec2'>) => Node<'float'>

/** Patchwork of fields with verges between them; of fields smaller than pixels, their mean. */
function fields(place: Node<'vec2'>, plan: DataTexture): Node<'vec3'> {
  const u = place.dot(vec2(COS, SIN)).toConst()
  const v = place.dot(vec2(-SIN, COS)).toConst()
  const [[wide, ofWide], [long, ofLong]] = BENDS
  const across = u
    .add(sin(v.div(ofWide)).mul(wide))
    .div(FIELD[0])
    .add(ORIGIN[0])
    .toConst()
  const even = v
    .add(sin(u.div(ofLong)).mul(long))
    .div(FIELD[1])
    .add(ORIGIN[1])
    .toConst()
  const column = floor(across).toConst()
  const along = even.add(column.mul(SHIFT)).toConst()
  const at = vec2(column, floor(along)).add(0.5).div(PLANNED)
  const field = texture(plan, at).level(int(0)).toConst()
  const crop = field.rgb.mul(BRIGHTEST)
  const pixel = vec2(fwidth(across).mul(FIELD[0]), fwidth(even).mul(FIELD[1])).toConst()
  const inField = vec2(fract(across), fract(along))
  const edge = inField
    .min(inField.oneMinus())
    .mul(vec2(...FIELD))
    .toConst()
  const side = smoothstep(vec2(HALF_VERGE).sub(pixel), vec2(HALF_VERGE).add(pixel), edge).oneMinus()
  const thin = pixel
    .div(2 * HALF_VERGE)
    .max(1)
    .reciprocal()
  const verges = side.mul(thin).toConst()
  const seen = smoothstep(vec2(...FIELD), vec2(...FIELD).mul(0.25), pixel).toConst()
  const swaths = sin(u.mul(2 * Math.PI * SWATHS))
    .mul(smoothstep(0.4, 0.15, pixel.x.mul(SWATHS)))
    .mul(field.a)
    .mul(0.06)
  const mixed = mix(vec3(...MEAN), crop.mul(swaths.add(1)), seen.x.mul(seen.y))
  const bare = smoothstep(HEDGES_GO[0], HEDGES_GO[1], place.length()).mul(0.45).add(0.4)
  return mix(mixed, vec3(...VERGE), verges.x.max(verges.y).mul(bare))
}

/** Blades and tufts of what grows, which fade as pixels average them: straw here and there, shade between. */
function grown(color: Node<'vec3'>, noise: Noise): Node<'vec3'> {
  // Sums of periods without a common multiple: one alone shows as rows.
  const blades = noise(1.13).add(noise(1.73)).add(noise(0.47).mul(0.5)).mul(0.5).toConst()
  const tufts = noise(5.3).add(noise(13.9)).mul(0.6).add(blades.mul(0.5)).toConst()
  const dry = smoothstep(0.3, 1, blades.sub(noise(23)))
  const low = smoothstep(-0.4, -1.2, tufts)
  const lit = color.mul(blades.mul(0.4).add(tufts.mul(0.12)).add(1).max(0.3))
  return mix(mix(lit, vec3(...STRAW), dry.mul(0.25)), vec3(...BETWEEN), low.mul(0.3))
}

/** Slope of a relief of noise. */
function slopeOf(
  place: Node<'vec2'>,
  { period, step, height }: typeof RELIEF,
  noise: Noise
): Node<'vec2'> {
  const east = noise(period, place.add(vec2(step, 0)))
  const south = noise(period, place.add(vec2(0, step)))
  return vec2(east, south)
    .sub(noise(period, place))
    .mul(height / step)
}

/**
 * Material of ground with an attribute `height` [m]: fields and woods below, rock above, all with grain down to some
 * decimetres.
 */
export function soilMaterial(soil: Soil): MeshStandardNodeMaterial {
  const { high, variation, isFarmed, isSnowy } = soil
  const material = new MeshStandardNodeMaterial({ roughness: 1 })
  const picture = createNoiseTexture()
  // Ground before one's feet is seen at a grazing angle.
  picture.anisotropy = 16
  material.addEventListener('dispose', () => picture.dispose())
  const place = positionWorld.xz
  // Five octaves from an eighth of the period on, about ±1; no two periods have a common multiple, and each is turned.
  const noise: Noise = (period, at = place) => {
    const [cos, sine] = [Math.cos(period), Math.sin(period)].map(t => t / period)
    const turned = vec2(at.dot(vec2(cos, sine)), at.dot(vec2(-sine, cos)))
    return texture(picture, turned).r.sub(0.5).mul(2)
  }
  const broad = noise(2930).add(noise(11_700)).toVar()
  const fine = noise(1.7).add(noise(9.1)).add(noise(47)).add(noise(410).mul(0.8)).toVar()
  const ground = attribute<'float'>('height', 'float')
  const height = ground.add(broad.mul(90)).toVar()
  const lit = fine.mul(variation).mul(0.8).add(1).max(0.3)
  const rough = slopeOf(place, RELIEF, noise).mul(smoothstep(20, 160, ground))
  const slope = isSnowy ? rough.add(slopeOf(place, DRIFTS, noise)) : rough
  const normal = normalWorldGeometry
    .sub(vec3(slope.x, 0, slope.y))
    .normalize()
    .toVar()
  material.normalNode = transformNormalToView(normal)
  const low = vec3(...(isSnowy ? meadow.low : soil.low))
  let color: Node<'vec3'> = low
  const steep = normal.y.oneMinus()
  if (isFarmed) {
    const plan = createFieldTexture()
    material.addEventListener('dispose', () => plan.dispose())
    const dry = smoothstep(-0.5, 0.6, noise(610).add(noise(89).mul(0.4)))
    const pasture = mix(low, vec3(...HEATH), dry.mul(smoothstep(40, 420, height)))
    color = grown(mix(fields(place, plan), pasture, smoothstep(25, 90, height)), noise)
    const ragged = noise(730).mul(0.5).add(noise(170).mul(0.22)).add(noise(61).mul(0.14))
    const wooded = broad.add(ragged).add(smoothstep(15, 220, height).mul(0.75))
    const woods = smoothstep(0.56, 0.64, wooded)
      .mul(smoothstep(20, 45, height))
      .toConst()
    // Crowns with shade between them.
    const crowns = noise(97).add(noise(37).mul(0.8)).mul(0.75).add(1).max(0.25)
    const kind = smoothstep(-0.25, 0.25, noise(570).add(noise(130).mul(0.5)))
    const canopy = mix(vec3(...FOREST), vec3(...LEAFY), kind).mul(crowns)
    color = mix(color, canopy, woods)
    if (isSnowy) {
      // It lies on fields, thinly where stubble or earth comes through, and between the trees of woods.
      const drifts = noise(31).add(noise(7.3).mul(0.6)).add(noise(1.9).mul(0.4))
      const bare = color.r.mul(1.6).add(drifts.mul(0.14)).sub(0.1).clamp(0, 0.3)
      const lies = mix(bare.oneMinus(), crowns.mul(0.16).add(0.1).clamp(0, 1), woods)
      color = mix(color, vec3(...soil.low), lies)
    }
  }
  color = mix(color, vec3(...high), smoothstep(480, 1000, height))
  // Cliffs.
  if (isFarmed && !isSnowy) color = mix(color, vec3(...high), smoothstep(0.22, 0.36, steep))
  material.colorNode = color.mul(lit)
  return material
}
