import { If, float, mix, vec2 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import {
  DEPTH_SIZE,
  RADIANCE_SCALE,
  VOLUME_SIZE,
  VOLUME_SLOTS,
  VOLUME_TILES
} from '../../tables/tableSizes'
import { sampleLevel0, type Bool, type Float, type Vec2, type Vec4 } from '../../tsl-types'
import { spreadCosine, spreadSun } from '../../diffuseLight/tsl/diffuseLight'
import type { Eye } from '../../view/tsl/eye'
import { miePhase } from '../../air/tsl/phase'
import { rowAndColumn } from '../../tables/tsl/texels'
import { sine } from '../../math/tsl/trigonometry'

const [AZIMUTHS, ELEVATIONS, DISTANCES] = VOLUME_SIZE
const [TILE_COLUMNS, TILE_ROWS] = VOLUME_TILES
const [DEPTH_COLUMNS, DEPTH_ROWS] = DEPTH_SIZE

/** Number of the tile that holds all the air along a ray and the ground behind it. */
export const SKY_TILE = DISTANCES

/** Textures of a sky volume. */
export interface VolumeTextures {
  /** Light scattered by molecules, and by aerosols more than once. */
  molecular: TextureNode
  /** Light scattered by aerosols once, without its phase function. */
  aerosol: TextureNode
  /** Mean extinction along rays [1/m]. */
  depth: TextureNode
}

/** Limits of a view ray: where it enters and leaves the air, or meets the ground. */
export interface RayLimits {
  /** Distance to where the air begins: 0 inside it [m]. */
  start: Float
  /** Distance from there to the ground or out of the air; 0 if the ray misses the air [m]. */
  length: Float
  hitsGround: Bool
}

/**
 * @param cosView - μ, ray against the zenith of the eye.
 * @param forcedGround - Whether the ray meets the ground, where rounding must not decide.
 */
export function rayLimits(eye: Eye, cosView: Float, forcedGround?: Bool): RayLimits {
  const radial = eye.radius.mul(cosView).toConst()
  const square = radial.mul(radial).toConst()
  const ground = square.sub(eye.toHorizon).toConst()
  const halfChord = square.add(eye.toTop).max(0).sqrt().toConst()
  const start = radial.negate().sub(halfChord).max(0).toConst()
  const top = halfChord.sub(radial).max(0)
  const hitsGround = forcedGround ?? ground.greaterThanEqual(0).and(cosView.lessThan(0)).toConst()
  // The near root as c / (−b + √D): the other form cancels close to the ground.
  const bottom = eye.toHorizon.div(ground.max(0).sqrt().sub(radial).max(1e-3))
  return {
    start: start,
    length: hitsGround.select(bottom, top).sub(start).max(0).toConst(),
    hitsGround
  }
}

/**
 * Position of an elevation in its half (below or above the horizon), in [0, 1] from the horizon:
 * √tan(α/2), α the angle from it.
 *
 * @param cosView - μ, ray against the zenith of the eye.
 * @param hitsGround - Which half.
 * @param sinView - √(1 − μ²), which from far away is better known than μ tells.
 */
function elevationPosition(eye: Eye, cosView: Float, hitsGround: Bool, sinView: Float): Float {
  const across = cosView.mul(eye.sinHorizon).sub(sinView.mul(eye.cosHorizon)).abs()
  const along = sinView.mul(eye.sinHorizon).add(cosView.mul(eye.cosHorizon))
  const scale = hitsGround.select(eye.belowScale, eye.aboveScale)
  return across.div(along.add(1).max(1e-6)).mul(scale).clamp().sqrt()
}

/** Row of a position in a table with that many rows, the lower half below the horizon, in texels. */
function elevationRow(position: Float, hitsGround: Bool, rows: number): Float {
  const half = rows / 2
  return position.mul(half - 1).add(hitsGround.select(0.5, half + 0.5))
}

/** Cosine of the zenith angle of a row, counted in whole texels. */
export function rowCosine(
  eye: Eye,
  row: Float,
  rows: number
): { cosView: Float; hitsGround: Bool; position: Float } {
  const half = rows / 2
  const hitsGround = row.lessThan(half).toConst()
  const position = row
    .floor()
    .sub(hitsGround.select(0, half))
    .div(half - 1)
    .toConst()
  const scale = hitsGround.select(eye.belowScale, eye.aboveScale)
  const tangent = position.mul(position).div(scale).toConst()
  const square = tangent.mul(tangent).toConst()
  const double = tangent.mul(hitsGround.select(-2, 2))
  const cosView = eye.cosHorizon
    .mul(square.oneMinus())
    .add(eye.sinHorizon.mul(double))
    .div(square.add(1))
    .clamp(-1, 1)
  return {
    cosView: cosView.toConst(),
    hitsGround: hitsGround,
    position: position
  }
}

/**
 * The sun's cosine where a ray from outside the air meets the ground or passes nearest to it:
 * the mean over azimuths, and the most that an azimuth adds or takes away.
 *
 * With b = r √(1 − μ²), the ray's distance from the planet's centre, the foot is half a chord
 * c = √(r_ground² − b²) before the nearest point, or that point.
 */
function sunAtFoot(
  uniforms: AtmosphereUniforms,
  eye: Eye,
  cosView: Float,
  sinView: Float,
  hitsGround: Bool
) {
  const { bottomRadius } = uniforms
  const nearest = eye.radius.mul(sinView).toConst()
  const square = bottomRadius.sub(nearest).mul(bottomRadius.add(nearest)).max(0)
  const chord = hitsGround.select(square.sqrt(), 0).toConst()
  const across = nearest.mul(cosView).add(chord.mul(sinView))
  const along = nearest.mul(sinView).sub(chord.mul(cosView))
  const inverse = hitsGround.select(bottomRadius, nearest.max(1)).reciprocal().toConst()
  return {
    mean: along.mul(inverse).mul(eye.cosSun).toConst() as Float,
    swing: across.mul(inverse).mul(eye.sinSun).abs().max(1e-4).toConst() as Float
  }
}

/**
 * Column of an azimuth φ from the sun, in texels.
 *
 * In the air: sin(φ/2), for the light is smooth in cos φ but changes most towards the sun. From outside
 * the azimuth sweeps over day, dusk and night: there columns crowd at dusk.
 *
 * @param cosView - μ.
 * @param cosViewSun - ν.
 */
function azimuthColumn(
  uniforms: AtmosphereUniforms,
  eye: Eye,
  cosView: Float,
  sinView: Float,
  cosViewSun: Float,
  hitsGround: Bool
): Float {
  const sines = sinView.mul(eye.sinSun).max(1e-6)
  const cosAzimuth = cosViewSun.sub(cosView.mul(eye.cosSun)).div(sines).clamp(-1, 1).toConst()
  const position = cosAzimuth.oneMinus().mul(0.5).sqrt().toVar()
  If(eye.toTop.lessThan(0), () => {
    const { mean, swing } = sunAtFoot(uniforms, eye, cosView, sinView, hitsGround)
    const first = spreadSun(mean.add(swing)).toConst()
    const last = spreadSun(mean.sub(swing))
    const here = spreadSun(mean.add(swing.mul(cosAzimuth)))
    position.assign(first.sub(here).div(first.sub(last)).clamp())
  })
  return position.mul(AZIMUTHS - 1).add(0.5)
}

/** ν of a column, counted in whole texels: the inverse of {@link azimuthColumn}. */
export function columnCosine(
  uniforms: AtmosphereUniforms,
  eye: Eye,
  cosView: Float,
  column: Float,
  hitsGround: Bool
): Float {
  const sinView = sine(cosView).toConst() as Float
  const position = column
    .floor()
    .div(AZIMUTHS - 1)
    .toConst()
  const cosAzimuth = position.mul(position).mul(2).oneMinus().toVar()
  If(eye.toTop.lessThan(0), () => {
    const { mean, swing } = sunAtFoot(uniforms, eye, cosView, sinView, hitsGround)
    const first = spreadSun(mean.add(swing)).toConst()
    const last = spreadSun(mean.sub(swing))
    const x = mix(first, last, position).toConst()
    cosAzimuth.assign(spreadCosine(x).sub(mean).div(swing).clamp(-1, 1))
  })
  const sines = sinView.mul(eye.sinSun)
  return cosView.mul(eye.cosSun).add(sines.mul(cosAzimuth)).clamp(-1, 1).toConst()
}

/** 1/κ and e^κ − 1 of a ray's distances. */
function spacing(eye: Eye, hitsGround: Bool): { stretch: Float; growth: Float } {
  return {
    stretch: hitsGround.select(eye.groundStretch, eye.skyStretch).toConst(),
    growth: hitsGround.select(eye.groundGrowth, eye.skyGrowth).toConst()
  }
}

/** Distance along a ray at a position x in [0, 1] among the slices [m]. */
export function sliceDistance(eye: Eye, limits: RayLimits, position: Float): Float {
  const { stretch, growth } = spacing(eye, limits.hitsGround)
  return position.div(stretch).exp().sub(1).div(growth).mul(limits.length)
}

/** Position among the slices of a distance, the inverse of {@link sliceDistance}. */
function slicePosition(eye: Eye, limits: RayLimits, distance: Float): Float {
  const { stretch, growth } = spacing(eye, limits.hitsGround)
  const part = distance.div(limits.length.max(1e-3)).clamp()
  return part.mul(growth).add(1).log().mul(stretch).clamp()
}

/** A row of the sky volumes. */
export interface Elevation {
  /** True if the ray meets the ground. */
  hitsGround: Bool
  /** Position of the elevation in its half, below or above the horizon, in [0, 1] from the horizon. */
  elevation: Float
}

/** Reads a table of {@link DEPTH_SIZE} at a column, in texels. */
function readDepth(
  depth: TextureNode,
  eye: Eye,
  { elevation, hitsGround }: Elevation,
  column: Float
): Vec4 {
  const row = elevationRow(elevation, hitsGround, DEPTH_ROWS).add(eye.slot.mul(DEPTH_ROWS))
  const size = vec2(1 / (DEPTH_COLUMNS + 1), 1 / (DEPTH_ROWS * VOLUME_SLOTS))
  return sampleLevel0(depth, vec2(column, row).mul(size))
}

/**
 * Mean extinction from where a ray enters the air to a position among the distances
 * [1/{@link EXTINCTION_SCALE} m].
 *
 * Depth over distance varies little from row to row, even just below the horizon, where the distance
 * to the ground varies most.
 */
export function meanExtinction(
  depth: TextureNode,
  eye: Eye,
  elevation: Elevation,
  position: Float
): Vec4 {
  return readDepth(depth, eye, elevation, position.mul(DEPTH_COLUMNS).max(1).sub(0.5))
}

/** Extinction is stored per this many metres, to stay clear of subnormal half floats. */
export const EXTINCTION_SCALE = 1e5

/** Light scattered between the eye and a point, with the optical depth between them. */
export interface AirBetween {
  /** For unit irradiance of the sun [1/sr]. */
  radiance: Vec4
  depth: Vec4
}

/** A direction from an eye as its sky volumes have it, whatever lights them. */
export interface Aim extends Elevation {
  /** μ, against the zenith of the eye. */
  cosView: Float
  /** √(1 − μ²). */
  sinView: Float
}

/** @param cosView - μ, direction against the zenith of the eye. */
export function aimAt(
  eye: Eye,
  cosView: Float,
  hitsGround: Bool,
  sinView: Float = sine(cosView).toConst()
): Aim {
  const elevation = elevationPosition(eye, cosView, hitsGround, sinView).toConst() as Float
  return { cosView, sinView, hitsGround, elevation }
}

/** Texture coordinates of a view ray in a tile of the atlas. */
function tileReader(
  uniforms: AtmosphereUniforms,
  eye: Eye,
  { cosView, sinView, hitsGround, elevation }: Aim,
  cosViewSun: Float
): (tile: Float) => Vec2 {
  const row = elevationRow(elevation, hitsGround, ELEVATIONS)
  const column = azimuthColumn(uniforms, eye, cosView, sinView, cosViewSun, hitsGround)
  const atlas = vec2(1 / (AZIMUTHS * TILE_COLUMNS), 1 / (ELEVATIONS * TILE_ROWS * VOLUME_SLOTS))
  const inSlot = row.add(eye.slot.mul(TILE_ROWS * ELEVATIONS))
  const first = vec2(column, inSlot).mul(atlas).toConst()
  return tile => {
    const { row: tileRow, column: tileColumn } = rowAndColumn(tile, TILE_COLUMNS)
    const size = vec2(1 / TILE_COLUMNS, 1 / (TILE_ROWS * VOLUME_SLOTS))
    return vec2(tileColumn, tileRow).mul(size).add(first).toConst()
  }
}

/** A point as an eye's sky volumes have it, whatever lights them. */
export interface VolumePlace extends Aim {
  /** Among the distances of its ray, in [0, 1]. */
  position: Float
  /** Optical depth up to it. */
  depth: Vec4
}

/**
 * @param cosView - μ, ray against the zenith of the eye.
 * @param limits - Of the same ray.
 * @param distance - From the eye [m].
 */
export function placeInVolume(
  textures: VolumeTextures,
  eye: Eye,
  cosView: Float,
  limits: RayLimits,
  distance: Float
): VolumePlace {
  const { hitsGround, length } = limits
  const aim = aimAt(eye, cosView, hitsGround)
  const inAir = distance.sub(limits.start).clamp(0, length).toConst() as Float
  const position = slicePosition(eye, limits, inAir).toConst() as Float
  const mean = meanExtinction(textures.depth, eye, aim, position)
  return { ...aim, position, depth: mean.mul(inAir.div(EXTINCTION_SCALE)).toConst() }
}

/** Reads the light of the air between the eye and a point from the volume, for unit irradiance [1/sr]. */
export function radianceBetween(
  uniforms: AtmosphereUniforms,
  textures: VolumeTextures,
  eye: Eye,
  place: VolumePlace,
  cosViewSun: Float
): Vec4 {
  const fetch = tileReader(uniforms, eye, place, cosViewSun)
  // Slice k ends at (k + 1)/N: before the first everything grows from nothing.
  const slices = place.position.mul(DISTANCES).toConst()
  const grown = slices
    .min(1)
    .mul(1 / RADIANCE_SCALE)
    .toConst()
  const slice = slices.sub(1).max(0).toConst()
  const near = slice
    .floor()
    .min(DISTANCES - 2)
    .toConst() as Float
  const weight = slice.sub(near).mul(grown).toConst()
  const phase = miePhase(uniforms, cosViewSun).toConst()
  const [from, to] = [near, near.add(1)].map(tile => readTile(textures, fetch(tile), phase))
  return from.mul(grown.sub(weight)).add(to.mul(weight))
}

/** Adds both parts, times the table's scale. */
function readTile(textures: VolumeTextures, at: Vec2, phase: Vec4): Vec4 {
  const light = sampleLevel0(textures.aerosol, at).mul(phase)
  return light.add(sampleLevel0(textures.molecular, at))
}

/**
 * Reads the air between the eye and a point from the volume.
 *
 * @param cosView - μ, ray against the zenith of the eye.
 * @param cosViewSun - ν, ray against sun.
 * @param limits - Of the same ray.
 * @param distance - From the eye [m].
 */
export function sampleVolume(
  uniforms: AtmosphereUniforms,
  textures: VolumeTextures,
  eye: Eye,
  cosView: Float,
  cosViewSun: Float,
  limits: RayLimits,
  distance: Float
): AirBetween {
  const place = placeInVolume(textures, eye, cosView, limits, distance)
  return {
    radiance: radianceBetween(uniforms, textures, eye, place, cosViewSun),
    depth: place.depth
  }
}

/** Tests of a view ray against ground and air. */
export function rayTargets(eye: Eye, cosView: Float): { hitsGround: Bool; meetsAir: Bool } {
  const radial = eye.radius.mul(cosView)
  const square = radial.mul(radial).toConst()
  const looksDown = cosView.lessThan(0)
  const crosses = square.add(eye.toTop).greaterThan(0).and(looksDown)
  return {
    hitsGround: square.greaterThanEqual(eye.toHorizon).and(looksDown).toConst(),
    meetsAir: eye.toTop.greaterThanEqual(0).or(crosses)
  }
}

/**
 * Reads the light of all the air in a direction and of the ground behind it from the volume, for unit
 * irradiance [1/sr].
 *
 * @param aim - Direction, which meets the air.
 * @param cosViewSun - ν, direction against the sun.
 */
export function sampleSky(
  uniforms: AtmosphereUniforms,
  textures: VolumeTextures,
  eye: Eye,
  aim: Aim,
  cosViewSun: Float
): Vec4 {
  const at = tileReader(uniforms, eye, aim, cosViewSun)(float(SKY_TILE))
  return readTile(textures, at, miePhase(uniforms, cosViewSun)).mul(1 / RADIANCE_SCALE)
}

/** A line of sight from an eye that meets the air. */
export interface Sight {
  /** μ, against the zenith of the eye. */
  cosView: Float
  /** √(1 − μ²), better known than μ tells. */
  sinView: Float
  /** ν, against the sun. */
  cosViewSun: Float
  /** True if the ground is behind. */
  hitsGround: Bool
  /** Of the way through the air, to the ground or out of it [m]. */
  length: Float
}

/** Reads all the air along a line of sight from the volume, without what is behind it: 3 fetches. */
export function sampleAir(
  uniforms: AtmosphereUniforms,
  textures: VolumeTextures,
  eye: Eye,
  { cosView, sinView, cosViewSun, hitsGround, length }: Sight
): AirBetween {
  const aim = aimAt(eye, cosView, hitsGround, sinView)
  // The slice before the ground's ends where the air does.
  const at = tileReader(uniforms, eye, aim, cosViewSun)(float(SKY_TILE - 1))
  const mean = meanExtinction(textures.depth, eye, aim, float(1))
  const light = readTile(textures, at, miePhase(uniforms, cosViewSun))
  return { radiance: light.mul(1 / RADIANCE_SCALE), depth: mean.mul(length.div(EXTINCTION_SCALE)) }
}

/** Transmittance of all the air in a direction; 1 where there is none. */
export function skyTransmittance(textures: VolumeTextures, eye: Eye, elevation: Elevation): Vec4 {
  return readDepth(textures.depth, eye, elevation, float(DEPTH_COLUMNS + 0.5)).toConst()
}
