import { Fn, If, float, mix, smoothstep, vec3 } from 'three/tsl'
import type { Float, Variable, Vec3 } from '../../tsl-types'
import type { GroundMaps } from '../maps/GroundMaps'
import { grainAt, leaning, type GroundDetail } from './grain'
import {
  groundClimate,
  groundRules,
  type GroundColors,
  type GroundLayers,
  type GroundPlace
} from './groundRules'
import { ripples } from './ripples'

/** Dry grass per climate: steppe is straw, wet country green. Less: land from orbit is of one colour (*Terrain*). */
const DRY_GRASS = 1.5

/** Mean square of the slopes of stones. */
const GRAIN_VARIANCE = 0.3

// Reflectances, linear sRGB: rock and sand of the ASTER library's order, snow of a few days, grass of early summer.
const ROCK = /*#__PURE__*/ vec3(0.19, 0.176, 0.158)
const DARK_ROCK = /*#__PURE__*/ vec3(0.105, 0.098, 0.092)
const SCREE = /*#__PURE__*/ vec3(0.238, 0.228, 0.21)
const TUNDRA = /*#__PURE__*/ vec3(0.095, 0.088, 0.05)
const SAND = /*#__PURE__*/ vec3(0.4, 0.32, 0.215)
const DESERT = /*#__PURE__*/ vec3(0.39, 0.265, 0.15)
const GRASS = /*#__PURE__*/ vec3(0.066, 0.1, 0.03)
const SOIL = /*#__PURE__*/ vec3(0.052, 0.04, 0.027)
const STRAW = /*#__PURE__*/ vec3(0.235, 0.195, 0.092)
const HEATH = /*#__PURE__*/ vec3(0.056, 0.058, 0.029)
const FOREST = /*#__PURE__*/ vec3(0.019, 0.031, 0.013)
const BROADLEAF = /*#__PURE__*/ vec3(0.036, 0.051, 0.016)
const SHRUB = /*#__PURE__*/ vec3(0.026, 0.034, 0.015)
const SNOW = /*#__PURE__*/ vec3(0.83, 0.86, 0.9)

/** Surface of the ground at a place. */
export interface GroundSurface {
  /** Reflectance, linear sRGB. */
  readonly color: Vec3
  /** Strands of what floats, about 0. */
  readonly tangle: Float
  /** Light of stones and blades over their mean, for colours of pictures. */
  readonly detail: Float
  /** Longer side of the pixel on the ground, and differences of height within it [m]. */
  readonly footprint: Float
  readonly spread: Float
  /** Roughness as of three's materials, which clamp it to 1. */
  readonly roughness: Float
  /** Gradient of stones, along the ground [–]. */
  readonly grain: Vec3
  /** Share of the sky's light that reaches between stones and blades. */
  readonly occlusion: Float
}

/** Texture maps and mask of the ground's surface. */
export interface OwnSurface {
  readonly maps: GroundMaps | null
  /** Layers where a mask has painted them, with edges that a height about 0 frays; without one as they are. */
  readonly paint: (layers: GroundLayers, relief: Float) => GroundLayers
}

/**
 * Rock, scree, grass, forest, sand and snow, by height, slope, curvature, latitude and noise, or by a mask; procedural, or of texture maps.
 *
 * @param seaLevel - Surface of the sea above the ellipsoid [m].
 */
export function groundSurface(
  place: GroundPlace,
  seaLevel: Float,
  { maps, paint }: OwnSurface,
  detail: GroundDetail
): GroundSurface {
  const { patch, climate } = place
  const ground = groundClimate(place, seaLevel)
  const { overSea, overTrees, sunny, lowland } = ground
  const grain = grainAt(place, detail)
  const { stone, blade, boulder, tuft, crown, brush } = grain
  const rules = groundRules(place, grain, ground)
  const { relief, spread } = rules
  const layers = paint(rules.layers, relief)
  const { snow, bare, inland, bareness, dryness, woods } = layers
  // Hollows are darker: damp, and full of shadows that are smaller than a page's texel.
  const tone = patch.mul(0.9).add(relief.mul(0.35)).sub(place.hollow.mul(0.9)).toConst()
  // Dark between stones, and between blades.
  const stony = stone.mul(0.45).add(1).toConst()
  const light = blade.mul(1.05).add(tuft.mul(0.2)).toConst()
  const rock = mix(DARK_ROCK, ROCK, tone.mul(1.1).add(0.55).clamp(0, 1)).mul(stony)
  // Drier and fresher spots of metres, dry blades and soil of centimetres: the brightest and the darkest of the picture.
  const spots = boulder.mul(0.8).add(tuft.mul(0.5)).add(brush.mul(0.9)).toConst()
  const parched = patch
    .mul(0.6)
    .add(spots)
    .add(sunny.mul(0.5))
    .add(climate.mul(DRY_GRASS).add(lowland.mul(0.4)))
  const straw = smoothstep(-0.3, 0.8, parched)
    .mul(0.75)
    .add(smoothstep(-900, 200, overTrees).mul(0.2))
    .max(smoothstep(0.36, 0.6, blade).mul(0.8))
  // Heather and dwarf shrubs lie in patches, more of them towards the tree line.
  const high = smoothstep(-900, 100, overTrees)
  const heath = smoothstep(-0.1, 0.35, spots.sub(patch.mul(0.9)).add(high.mul(0.4)).sub(0.4))
  const turf = mix(mix(GRASS, STRAW, straw), HEATH, heath.mul(0.65))
  const blades = turf.mul(light.add(brush.mul(0.35)).add(1).max(0.2))
  const grassland = mix(blades, SOIL, smoothstep(0.08, 0.28, blade.negate()).mul(0.8))
  // Shrubs stand in it, more of them towards the woods.
  const shrubs = smoothstep(0.3, 0.5, crown.add(patch.sub(dryness).mul(0.35)).sub(0.05)).toConst()
  const meadow = mix(grassland, SHRUB, shrubs.mul(0.75)).toConst() as Vec3
  const leaves = mix(FOREST, BROADLEAF, smoothstep(-0.5, 0.5, brush.mul(1.5).add(climate)))
  const floor = leaves.mul(light.mul(1.3).add(crown.mul(1.2)).add(1).max(0.3))
  const forest = mix(meadow, floor, tone.mul(0.2).add(0.85).clamp(0, 1))
  const desert = DESERT.mul(tone.mul(0.35).add(1)).mul(stony)
  // Turf of sedges and lichen lies between the stones, most of it just above the trees.
  const turfed = smoothstep(-0.45, 0.3, patch.sub(overTrees.mul(1 / 2500)).add(stone.mul(-0.5)))
  const stones = SCREE.mul(tone.mul(0.6).add(1).clamp(0.4, 1.3))
  const scree = mix(stones, TUNDRA, turfed.mul(0.75)).mul(stony)
  const tangle = blade.add(boulder.mul(0.3))
  const sand = SAND.mul(tuft.mul(0.06).add(patch.mul(0.35)).add(1))
  const wet = smoothstep(0, 1.2, overSea.add(stone.mul(0.06))).toConst()
  const colors = { snow: SNOW, rock, sand, scree, desert, forest, grass: meadow }
  const mapped = maps?.groundAt(place, layers, colors)
  /** A value as made up, and that of maps where there are any. */
  const either = (own: Float, ofMaps: Float = float(0)): Float =>
    mapped ? mix(own, ofMaps, mapped.share) : own
  const made = mapped?.color ?? layered(layers, colors, [tone, stony, light, shrubs])
  const dry = made.mul(wet.mul(0.45).add(0.55))

  // Stones stand out of rock and scree, hardly out of grass, sand and snow.
  const stoniness = mix(bareness.mul(0.8).add(dryness.mul(0.15)).add(0.03), float(0.9), bare)
  const bump = either(stoniness.mul(inland.max(bare)).mul(snow.mul(-0.96).add(1))).toConst()
  const ownRough = mix(wet.mul(0.35).add(0.6), 0.75, snow)
  const rough = either(ownRough, mapped?.roughness.mul(wet.mul(0.37).add(0.63)))
  // Slopes that are smaller than a pixel roughen it: α² grows by twice their variance (Kaplanyan et al. 2016).
  const roughSquare = rough.mul(rough)
  const alpha = roughSquare.mul(roughSquare).add(
    bump
      .mul(bump)
      .mul(grain.lost)
      .mul(2 * GRAIN_VARIANCE)
  )
  const leafy = woods
    .max(shrubs)
    .mul(bare.max(bareness).max(dryness).max(snow).oneMinus())
    .mul(inland)
  const raised = mix(mix(bump.mul(0.55).max(0.06), float(0.7), leafy), float(0.06), snow).toConst()
  const hollow = stone
    .add(boulder.mul(0.5))
    .min(0)
    .mul(bump)
    .add(blade.min(0).mul(0.8))
    .add(crown.min(0).mul(raised))
  const occlusion = hollow.mul(0.9).add(1).max(0.3)
  const slopes = grain
    .gradient(bump, bump.mul(bareness.max(bare).mul(0.6)))
    .add(leaning(grain.canopySlope.mul(raised)))
    .add(ripples(place.offset, spots, grain.footprint).mul(either(inland.max(bare).oneMinus())))
  return {
    tangle,
    detail: mix(light.mul(0.8), stone.mul(0.45), bareness.max(bare)).add(1),
    footprint: grain.footprint,
    spread,
    color: dry,
    roughness: alpha.sqrt().sqrt(),
    grain: mapped ? slopes.add(mapped.slope.mul(mapped.share)) : slopes,
    occlusion: either(occlusion, mapped?.occlusion)
  }
}

/**
 * Colour of the ground of materials that lie on each other, each found where there is any of it.
 *
 * @param shared - Values that several of them need.
 */
const layered = (layers: GroundLayers, colors: GroundColors, shared: Float[]): Vec3 =>
  Fn(() => {
    for (const value of [...Object.values(layers), ...shared]) {
      ;(value as unknown as { toStack(): void }).toStack()
    }
    const { snow, bare, inland, bareness, dryness, woods } = layers
    const made = vec3(0).toVar() as unknown as Variable<Vec3>
    const lay = (share: Float, layer: Vec3): void => {
      If(share.greaterThan(0), () => {
        made.assign(mix(made, layer, share))
      })
    }
    If(bare.max(snow).lessThan(1), () => {
      made.assign(colors.grass)
      lay(woods, colors.forest)
      lay(dryness, colors.desert)
      lay(bareness, colors.scree)
      lay(inland.oneMinus(), colors.sand)
    })
    lay(bare, colors.rock)
    made.assign(mix(made, colors.snow, snow))
    return made
  })()
