import {
  cameraViewMatrix,
  float,
  fwidth,
  materialColor,
  materialRoughness,
  mix,
  mx_noise_float,
  normalViewGeometry,
  normalWorldGeometry,
  positionWorld,
  smoothstep,
  time as clock,
  vec3,
  vec4
} from 'three/tsl'
import type { Node } from 'three/webgpu'
import { checkOptions, fail } from '@welkin/geo'
import type { Float, Mat4, Vec3 } from '../tsl-types'
import { SurfaceWater } from './SurfaceWater'
import { rippleSlope, rippleVariance, seenRipples } from './tsl/rippleSlope'

/** Options of {@link wetSurface}: nodes; each has a default. */
export interface WetSurfaceOptions {
  /** Albedo when dry; by default the material's colour and map. */
  color?: Node<'vec3'>
  /** Roughness when dry; by default the material's. */
  roughness?: Node<'float'>
  /** Normal when dry, in view space; by default the geometry's. */
  normal?: Node<'vec3'>
  /** Place on the surface, y up [m]; by default the world position. In worlds far from their origin give one that float32 holds. */
  position?: Node<'vec3'>
  /** Height within hollows, in [0, 1]: 0 fills first, and keeps snow longest; by default noise 3 m wide. */
  hollows?: Node<'float'>
  /** Share of the darkening that the surface takes, in [0, 1]: 1 for what is porous or rough, 0 for metal and glass; by default 1. */
  porosity?: Node<'float'>
  /** Share of the rain, and of the snow, that reaches it, in [0, 1]: 0 under a roof; by default 1. */
  exposure?: Node<'float'>
  /** Time of the ripples [s]; by default three's clock. */
  time?: Node<'float'>
}

/** Nodes for a `MeshStandardNodeMaterial`, as {@link wetSurface} makes them. */
export interface WetSurfaceNodes {
  /** Albedo. */
  colorNode: Node<'vec3'>
  /** Roughness, in (0, 1]. */
  roughnessNode: Node<'float'>
  /** Unit normal in view space. */
  normalNode: Node<'vec3'>
}

const NAME = 'wetSurface'
const OPTIONS = [
  'color',
  'roughness',
  'normal',
  'position',
  'hollows',
  'porosity',
  'exposure',
  'time'
] as const
/** Square of water's refractive index. */
const INDEX_SQUARED = 1.333 ** 2
/** Roughness of a film of water and of a puddle. */
const FILM_ROUGHNESS = 0.15
const PUDDLE_ROUGHNESS = 0.04
const SNOW_ROUGHNESS = 0.9
/** Albedo of clean new snow in red, green and blue: about 0.95 (Wiscombe & Warren 1980). */
const SNOW_ALBEDO = [0.93, 0.95, 0.96] as const
/** Upward component of normals from which puddles stand, and snow lies. */
const LEVEL = [0.97, 0.995] as const
const HOLDS_SNOW = [0.45, 0.75] as const
/**
 * Height over which puddles thin out to a film, over that of hollows: the texture of smooth asphalt is some 0.4 mm deep, hollows 2 mm. A pixel's height comes on top, half on each side.
 * Smaller: hard edges (*Rain and snow in a street*).
 */
const SHORE = 0.2

/**
 * Albedo of a rough surface under a film of water: of the light that it scatters, 1 − 1/n² comes back by total reflection.
 *
 * @param albedo - When dry, in [0, 1].
 * @see Ångström 1925, "The albedo of various surfaces of ground", Geogr. Ann. 7, pp. 323–342; Lekner & Dorf 1988, "Why some things are darker when wet", Appl. Opt. 27, pp. 1278–1280
 */
const wetAlbedo = (albedo: Vec3): Vec3 =>
  albedo.div(albedo.oneMinus().mul(INDEX_SQUARED).add(albedo))

/**
 * Nodes that wet a material and let snow lie on it: darker, smoother, with puddles in hollows and rings of drops on them.
 *
 * ```ts
 * Object.assign(road, wetSurface(water, { porosity: float(0.8) }))
 * ```
 *
 * @param water - Water and snow on the surface. Shared, not owned.
 * @returns `colorNode`, `roughnessNode` and `normalNode` of a `MeshStandardNodeMaterial`.
 * @throws If an argument is of the wrong kind.
 */
export function wetSurface(water: SurfaceWater, options: WetSurfaceOptions = {}): WetSurfaceNodes {
  if (!(water instanceof SurfaceWater)) fail(NAME, 'water must be a SurfaceWater', water)
  checkOptions(NAME, options, ...OPTIONS)
  for (const key of OPTIONS) {
    const node = options[key]
    if (node !== undefined && !node?.isNode) fail(NAME, `${key} must be a node`, node)
  }
  const position = (options.position ?? positionWorld) as Vec3
  const dry = (options.color ?? vec3(materialColor as unknown as Vec3)) as Vec3
  const dryRoughness = (options.roughness ?? materialRoughness) as Float
  const dryNormal = (options.normal ?? normalViewGeometry) as Vec3
  const exposure = options.exposure ?? float(1)
  const upward = normalWorldGeometry.y as unknown as Float
  const noise = mx_noise_float(position.mul(0.33)) as unknown as Float
  const hollows = (options.hollows ?? noise.mul(0.8).add(0.5).clamp()) as Float

  const wet = water.wetnessNode.mul(exposure)
  const filled = water.puddlesNode.mul(exposure).mul(1 + SHORE)
  const half = (fwidth(hollows) as unknown as Float).mul(0.5)
  const deep = hollows
    .add(half)
    .add(SHORE)
    .min(1 + SHORE)
  const puddle = smoothstep(hollows.sub(half).max(0), deep, filled).mul(
    smoothstep(...LEVEL, upward)
  )
  const covered = water.snowCoverNode.mul(exposure).mul(1.1)
  const snow = smoothstep(hollows.sub(0.1), hollows.add(0.1), covered.sub(0.1))
    .mul(smoothstep(...HOLDS_SNOW, upward))
    .mul(smoothstep(0, 0.02, covered))

  const darkened = mix(dry, wetAlbedo(dry), wet.max(puddle).mul(options.porosity ?? float(1)))
  // Pores fill first, and only then a film smooths.
  const film = mix(dryRoughness, dryRoughness.min(FILM_ROUGHNESS), wet.mul(wet))
  const time = (options.time ?? clock) as Float
  const seen = seenRipples(position.xz).toConst() as Float
  // Ripples too small to be seen make water rough: α² grows by twice the variance of their slope (Beckmann & Spizzichino 1963).
  const unseen = rippleVariance(water.ringRateNode).mul(seen.mul(seen).oneMinus().mul(2))
  const rough = unseen
    .add(PUDDLE_ROUGHNESS ** 4)
    .sqrt()
    .sqrt()
  const smooth = mix(film, rough, puddle)
  const slope = rippleSlope(position.xz, time, water.ringRateNode).mul(seen)
  const surface = vec4(slope.x.negate(), 1, slope.y.negate(), 0)
  const rippled = (cameraViewMatrix as unknown as Mat4).mul(surface).xyz as Vec3
  const bare = puddle.mul(snow.oneMinus())
  return {
    colorNode: mix(darkened, vec3(...SNOW_ALBEDO), snow),
    roughnessNode: mix(smooth, float(SNOW_ROUGHNESS), snow),
    normalNode: mix(dryNormal, rippled, bare).normalize()
  }
}
