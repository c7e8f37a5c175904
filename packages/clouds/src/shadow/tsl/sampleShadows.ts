import type { Vector2, Vector3, Vector4 } from 'three'
import { If, float, log2, mix, vec2, vec3, vec4 } from 'three/tsl'
import type { UniformNode } from 'three/webgpu'
import type { Float, LevelTexture, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { CASCADE_SIZE } from '../CascadeState'
import { CASCADE_RATIO, MAXIMUM_DISTANCE } from './shadowRay'

/** Uniforms to look a cascade up: rows that turn (offset, 1) into u, v and height over the plane in half widths. */
export interface CascadeNodes {
  readonly u: UniformNode<'vec4', Vector4>
  readonly v: UniformNode<'vec4', Vector4>
  readonly w: UniformNode<'vec4', Vector4>
  /** 1 once it is drawn for clouds and surfaces, and once it is for the air. */
  readonly isDrawn: UniformNode<'float', number>
  readonly isCast: UniformNode<'float', number>
  /** Index of its tile in the map. */
  readonly atlasTile: UniformNode<'float', number>
}

/** A shadow map as shaders see it. */
export interface CloudShadows {
  readonly map: LevelTexture<Vec2>
  readonly cascades: readonly CascadeNodes[]
  /** Size of a tile in texture coordinates: other things may lie beside and below. */
  readonly scale: UniformNode<'vec2', Vector2>
  /** 1 for a map of moonlight, 0 of sunlight. */
  readonly isMoonlit: UniformNode<'float', number>
  /** Displacement from the camera of the map to the one of the shader, if they are two [m]. */
  readonly shift?: UniformNode<'vec3', Vector3>
}

/** Optical depths on the ray of light through a place, not scaled. */
export interface LightDepths {
  /** Optical depth from the point to the light. */
  toLight: Float
  /** Optical depth from end to end of the ray. */
  through: Float
  /** Optical depth from the point to the light, of layers that cast shadows. */
  shadow: Float
  /** 1 where the map has the place, falling to 0 at its edges; depths are times as much. */
  inMap: Float
}

/** Optical depths of a place that is looked up by itself. */
export interface PlaceDepths extends LightDepths {
  /** Length of the even stretch that stands for the clouds on the ray [m], times their optical depth. */
  stretch: Float
}

/** Parts of a cascade's width that are left out at its edges: bilinear reads would mix in another one's. */
const MARGIN = 0.02

/**
 * Parts of its width in which a cascade gives way to the next. Fewer: a line where shadows become coarser
 * (*Shadows*).
 */
const FADE = 0.1

/**
 * Turns per octave of the distance from the camera by which places along a ray towards the light, or away from it, are moved
 * across a texel, up to half of one to either side: such a ray stays in few texels, whose edges would show as blocks (*shower* under a low sun).
 */
const TURNS = [3.1, 5.3] as const

/** Sine of the angle between ray and light from which on places are not moved: they are in many texels anyway. */
const MOVED_WITHIN = 0.3

/** Heights over the plane at which rays of the next narrower cascade end, in half widths of this one. */
const NARROWER_END = MAXIMUM_DISTANCE / CASCADE_RATIO

/**
 * Optical depths at a place, from the narrowest cascade that holds it. What its rays are too short for, under a
 * low sun and below tall clouds, comes from the wider ones: without, storms are bright where cascades meet.
 */
export function sampleShadows(
  { map, cascades, scale, shift }: CloudShadows,
  offset: Vec3
): PlaceDepths {
  const from = (shift === undefined ? offset : offset.add(shift)).toConst()
  /** Depths to the light, of all layers and of those that cast shadows; through; weight of the map. */
  const found = vec4(0).toVar() as Vec4
  const stretch = float(0).toVar()
  /** Depths to the light from the end of the next narrower cascade's rays on. */
  const beyond = vec2(0).toVar() as Vec2
  for (const { u, v, w, isDrawn, atlasTile } of cascades.toReversed()) {
    const [x, y, above] = [u, v, w].map(row => row.xyz.dot(from).add(row.w).toConst() as Float)
    const aside = vec3(vec2(x, y).sub(0.5), above.div(2 * MAXIMUM_DISTANCE)).abs()
    const edge = aside.x.max(aside.y).max(aside.z)
    const weight = edge
      .mul(-1 / FADE)
      .add((0.5 - MARGIN) / FADE)
      .clamp()
      .mul(isDrawn)
      .toConst()
    const texel = map
      .sample(vec2(x.add(atlasTile), y).mul(scale))
      .level(0)
      .toConst() as Vec4
    const own = texel.zw.mul(shareAbove(texel, above)).add(beyond)
    found.assign(mix(found, vec4(own, texel.z.add(beyond.x), 1), weight))
    // u's length is 1 over the cascade's width.
    stretch.assign(mix(stretch, texel.y.div(u.xyz.length()), weight))
    const behind = texel.zw.mul(shareAbove(texel, float(NARROWER_END)))
    beyond.assign(beyond.add(behind).mul(weight))
  }
  const { x: toLight, y: shadow, z: through, w: inMap } = found
  return { toLight, through, stretch, shadow, inMap }
}

/** Share of a texel's clouds that is above a height over the cascade's plane: front and half length come times the depth. */
const shareAbove = ({ x: front, y: half, z: depth }: Vec4, height: Float): Float =>
  front.sub(depth.mul(height)).div(half.mul(2).max(1e-6)).clamp().toConst()

/** Optical depths at a place: texture coordinates (xy), height over the cascade's plane (z), and weight of the map there (w). */
function depthsAt(map: CloudShadows['map'], inAtlas: Vec4): LightDepths {
  const inMap = inAtlas.w.toConst() as Float
  const texel = map.sample(inAtlas.xy).level(0).mul(inMap).toConst() as Vec4
  const share = shareAbove(texel, inAtlas.z)
  const toLight = texel.z.mul(share).toConst() as Float
  return { toLight, through: texel.z, shadow: texel.w.mul(share).toConst(), inMap }
}

/**
 * Optical depths along a ray: as {@link sampleShadows} has them, for less at each place, since cascades are
 * chosen by the stretch of the ray that is in them.
 *
 * @param from - Start of the ray, from the camera of the map [m].
 * @param direction - Unit length.
 * @param dither - Noise in [0, 1), in which cascades meet.
 * @returns Depths by the distance from the start [m].
 */
export function sampleShadowsAlong(
  { map, cascades, scale }: CloudShadows,
  from: Vec3,
  direction: Vec3,
  dither: Float
): (distance: Float) => LightDepths {
  const edge = dither.mul(-FADE).add(0.5 - MARGIN)
  const extent = vec3(edge, edge, edge.mul(2 * MAXIMUM_DISTANCE)).toConst() as Vec3
  const stretches = cascades.map(({ u, v, w, isCast, atlasTile }) => {
    const along = (inAtlas: Vec3): Vec3 =>
      vec3(inAtlas.dot(u.xyz), inAtlas.dot(v.xyz), inAtlas.dot(w.xyz))
    const start = along(from)
      .add(vec3(u.w, v.w, w.w))
      .toConst() as Vec3
    const slope = along(direction).toConst() as Vec3
    // A ray that is level in an axis is in the cascade everywhere, or nowhere.
    const perSlope = vec3(1).div(slope.add(1e-12)).toConst() as Vec3
    const middle = vec3(0.5, 0.5, 0).sub(start).mul(perSlope).toConst() as Vec3
    const half = extent.mul(perSlope.abs()).toConst() as Vec3
    const [first, last] = [middle.sub(half), middle.add(half)]
    const toAtlas = vec3(scale, 1)
    return {
      start: start
        .add(vec3(atlasTile, 0, 0))
        .mul(toAtlas)
        .toConst(),
      slope: slope.mul(toAtlas).toConst(),
      first: first.x.max(first.y).max(first.z).toConst(),
      // Cascades that are not drawn end at the camera.
      last: last.x.min(last.y).min(last.z).mul(isCast).toConst()
    }
  })
  const [{ u, v }] = cascades
  const sine = vec2(u.xyz.dot(direction), v.xyz.dot(direction))
    .length()
    .div(u.xyz.length().max(1e-12))
  const moved = sine.div(-MOVED_WITHIN).add(1).max(0)
  const texel = scale.div(CASCADE_SIZE).mul(moved).toConst() as Vec2
  return distance => {
    const aside = log2(distance.max(1))
      .mul(vec2(...TURNS))
      .fract()
      .sub(0.5)
      .mul(texel)
      .toConst() as Vec2
    const inAtlas = vec4(0).toVar() as Vec4 & { assign: (n: Vec4) => void }
    // From the widest to the narrowest: the last that fits stays.
    for (const { start, slope, first, last } of stretches.toReversed()) {
      If(distance.greaterThan(first).and(distance.lessThan(last)), () => {
        inAtlas.assign(vec4(start.add(slope.mul(distance)).add(vec3(aside, 0)), 1))
      })
    }
    return depthsAt(map, inAtlas)
  }
}
