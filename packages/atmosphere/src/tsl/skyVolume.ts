import { If, float, mix, vec2 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import { DEPTH_SIZE, VOLUME_SIZE, VOLUME_SLOTS, VOLUME_TILES } from '../tableSizes'
import { sampleLevel0, type Bool, type Float, type Vec2, type Vec4 } from '../tsl-types'
import { distanceToGround, groundDiscriminant } from './boundary'
import { spreadCosine, spreadSun } from './diffuseLight'
import type { Eye } from './eye'
import type { Scattered } from './scattering'
import { rowAndColumn } from './texels'
import { sine } from './trigonometry'

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

/** Where a ray from the eye enters and leaves the air, or meets the ground. */
export interface RayLimits {
  /** Distance to where the air begins: 0 inside it [m]. */
  start: Float
  /** From there to the ground or out of the air; 0 if the ray misses the air [m]. */
  length: Float
  hitsGround: Bool
}

/**
 * @param cosView - μ, ray against the zenith of the eye.
 * @param forcedGround - Whether the ray meets the ground, where rounding must not decide.
 */
export function rayLimits(
  uniforms: AtmosphereUniforms,
  eye: Eye,
  cosView: Float,
  forcedGround?: Bool
): RayLimits {
  const { bottomRadius, thickness } = uniforms
  const radial = bottomRadius.add(eye.altitude).mul(cosView).toConst()
  const ground = groundDiscriminant(eye.altitude, cosView, bottomRadius).toConst() as Float
  const gap = thickness.sub(eye.altitude).mul(bottomRadius.mul(2).add(thickness).add(eye.altitude))
  const halfChord = radial.mul(radial).add(gap).max(0).sqrt().toConst()
  const start = radial.negate().sub(halfChord).max(0).toConst()
  const top = halfChord.sub(radial).max(0)
  const hitsGround = forcedGround ?? ground.greaterThanEqual(0).and(cosView.lessThan(0)).toConst()
  const bottom = distanceToGround(eye.altitude, cosView, ground, bottomRadius)
  return {
    start: start,
    length: hitsGround.select(bottom, top).sub(start).max(0).toConst(),
    hitsGround
  }
}

/**
 * Where an elevation lies in its half (below or above the horizon), in [0, 1] from the horizon:
 * √tan(α/2), α the angle from it.
 *
 * @param cosView - μ, ray against the zenith of the eye.
 * @param hitsGround - Which half.
 * @param sinView - √(1 − μ²), which from far away is better known than μ tells.
 */
function elevationPosition(
  eye: Eye,
  cosView: Float,
  hitsGround: Bool,
  sinView: Float = sine(cosView).toConst()
): Float {
  const across = cosView.mul(eye.sinHorizon).sub(sinView.mul(eye.cosHorizon)).abs()
  const along = sinView.mul(eye.sinHorizon).add(cosView.mul(eye.cosHorizon))
  const span = hitsGround.select(eye.belowSpan, eye.aboveSpan)
  return across.div(along.add(1).max(1e-6)).div(span).clamp().sqrt()
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
  const span = hitsGround.select(eye.belowSpan, eye.aboveSpan)
  const tangent = position.mul(position).mul(span).toConst()
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
  const nearest = bottomRadius.add(eye.altitude).mul(sinView).toConst()
  const square = bottomRadius.sub(nearest).mul(bottomRadius.add(nearest)).max(0)
  const chord = hitsGround.select(square.sqrt(), 0).toConst()
  const across = nearest.mul(cosView).add(chord.mul(sinView))
  const along = nearest.mul(sinView).sub(chord.mul(cosView))
  const inverse = hitsGround.select(bottomRadius, nearest.max(1)).reciprocal().toConst()
  const sinSun = sine(eye.cosSun)
  return {
    mean: along.mul(inverse).mul(eye.cosSun).toConst() as Float,
    swing: across.mul(inverse).mul(sinSun).abs().max(1e-4).toConst() as Float
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
  const sines = sinView.mul(sine(eye.cosSun)).max(1e-6)
  const cosAzimuth = cosViewSun.sub(cosView.mul(eye.cosSun)).div(sines).clamp(-1, 1).toConst()
  const position = cosAzimuth.oneMinus().mul(0.5).sqrt().toVar()
  If(eye.altitude.greaterThan(uniforms.thickness), () => {
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
  If(eye.altitude.greaterThan(uniforms.thickness), () => {
    const { mean, swing } = sunAtFoot(uniforms, eye, cosView, sinView, hitsGround)
    const first = spreadSun(mean.add(swing)).toConst()
    const last = spreadSun(mean.sub(swing))
    const x = mix(first, last, position).toConst()
    cosAzimuth.assign(spreadCosine(x).sub(mean).div(swing).clamp(-1, 1))
  })
  const sines = sinView.mul(sine(eye.cosSun))
  return cosView.mul(eye.cosSun).add(sines.mul(cosAzimuth)).clamp(-1, 1).toConst()
}

/** κ and e^κ − 1 of a ray's distances. */
function spacing(eye: Eye, hitsGround: Bool): { exponent: Float; growth: Float } {
  return {
    exponent: hitsGround.select(eye.groundExponent, eye.skyExponent).toConst(),
    growth: hitsGround.select(eye.groundGrowth, eye.skyGrowth).toConst()
  }
}

/** Distance along a ray at a position x in [0, 1] among the slices [m]. */
export function sliceDistance(eye: Eye, limits: RayLimits, position: Float): Float {
  const { exponent, growth } = spacing(eye, limits.hitsGround)
  return exponent.mul(position).exp().sub(1).div(growth).mul(limits.length)
}

/** Position among the slices of a distance, the inverse of {@link sliceDistance}. */
function slicePosition(eye: Eye, limits: RayLimits, distance: Float): Float {
  const { exponent, growth } = spacing(eye, limits.hitsGround)
  const part = distance.div(limits.length.max(1e-3)).clamp()
  return part.mul(growth).add(1).log().div(exponent).clamp()
}

/**
 * Mean extinction from where a ray enters the air to a position among the distances [1/m].
 *
 * Depth over distance varies little from row to row, even just below the horizon, where the distance
 * to the ground varies most.
 *
 * @param elevation - Position in the ray's half.
 */
export function meanExtinction(
  depth: TextureNode,
  eye: Eye,
  elevation: Float,
  hitsGround: Bool,
  position: Float
): Vec4 {
  const row = elevationRow(elevation, hitsGround, DEPTH_ROWS).add(eye.slot.mul(DEPTH_ROWS))
  const column = position.mul(DEPTH_COLUMNS).max(1).sub(0.5)
  const uv = vec2(column.div(DEPTH_COLUMNS), row.div(DEPTH_ROWS * VOLUME_SLOTS))
  return sampleLevel0(depth, uv).mul(1 / EXTINCTION_SCALE)
}

/** Extinction is stored per this many metres, to stay clear of subnormal half floats. */
export const EXTINCTION_SCALE = 1e5

/** Light scattered between the eye and a point, with the optical depth between them. */
export interface AirBetween extends Scattered {
  depth: Vec4
}

/** Reads a tile of the atlas in a direction. */
type TileReader = (source: TextureNode, tile: Float) => Vec4

function tileReader(
  uniforms: AtmosphereUniforms,
  eye: Eye,
  cosView: Float,
  cosViewSun: Float,
  elevation: Float,
  hitsGround: Bool,
  sinView: Float = sine(cosView).toConst()
): TileReader {
  const row = elevationRow(elevation, hitsGround, ELEVATIONS)
  const column = azimuthColumn(uniforms, eye, cosView, sinView, cosViewSun, hitsGround)
  const inTile = vec2(column, row).toConst() as Vec2
  const atlas = vec2(1 / (AZIMUTHS * TILE_COLUMNS), 1 / (ELEVATIONS * TILE_ROWS * VOLUME_SLOTS))
  return (source, tile) => {
    const { row: tileRow, column: tileColumn } = rowAndColumn(tile, TILE_COLUMNS)
    const corner = vec2(
      tileColumn.mul(AZIMUTHS),
      tileRow.add(eye.slot.mul(TILE_ROWS)).mul(ELEVATIONS)
    )
    return sampleLevel0(source, inTile.add(corner).mul(atlas))
  }
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
  const { hitsGround, length } = limits
  const elevation = elevationPosition(eye, cosView, hitsGround).toConst() as Float
  const fetch = tileReader(uniforms, eye, cosView, cosViewSun, elevation, hitsGround)
  const inAir = distance.sub(limits.start).clamp(0, length).toConst() as Float
  const position = slicePosition(eye, limits, inAir).toConst() as Float
  const depth = meanExtinction(textures.depth, eye, elevation, hitsGround, position).mul(inAir)
  // Slice k ends at (k + 1)/N: before the first everything grows from nothing.
  const exists = length.greaterThan(0).select(1, 0)
  const grown = position.mul(DISTANCES).min(1).mul(exists).toConst()
  const slice = position.mul(DISTANCES).sub(1).max(0).toConst()
  const near = slice
    .floor()
    .min(DISTANCES - 2)
    .toConst() as Float
  const far = near.add(1) as Float
  const part = slice.sub(near)
  const read = (source: TextureNode): Vec4 =>
    mix(fetch(source, near), fetch(source, far), part).mul(grown)
  return { molecular: read(textures.molecular), aerosol: read(textures.aerosol), depth }
}

/** Which rays from an eye meet the ground, and which the air at all. */
export function rayTargets(uniforms: AtmosphereUniforms, eye: Eye, cosView: Float) {
  const { bottomRadius, thickness } = uniforms
  const discriminant = groundDiscriminant(eye.altitude, cosView, bottomRadius).toConst()
  const looksDown = cosView.lessThan(0)
  const shell = thickness.mul(bottomRadius.mul(2).add(thickness))
  const isOutside = eye.altitude.greaterThan(thickness)
  return {
    hitsGround: discriminant.greaterThanEqual(0).and(looksDown).toConst() as Bool,
    meetsAir: isOutside.not().or(discriminant.add(shell).greaterThan(0).and(looksDown)) as Bool
  }
}

/**
 * Reads the light of all the air in a direction and of the ground behind it from the volume.
 *
 * @param cosView - μ, direction against the zenith of the eye; it meets the air.
 * @param cosViewSun - ν, direction against the sun.
 * @param hitsGround - Whether the ground is behind.
 */
export function sampleSky(
  uniforms: AtmosphereUniforms,
  textures: VolumeTextures,
  eye: Eye,
  cosView: Float,
  cosViewSun: Float,
  hitsGround: Bool
): Scattered {
  const elevation = elevationPosition(eye, cosView, hitsGround).toConst() as Float
  const fetch = tileReader(uniforms, eye, cosView, cosViewSun, elevation, hitsGround)
  const tile = float(SKY_TILE) as Float
  return { molecular: fetch(textures.molecular, tile), aerosol: fetch(textures.aerosol, tile) }
}

/** A line of sight from an eye that meets the air. */
export interface Sight {
  /** μ, against the zenith of the eye. */
  cosView: Float
  /** √(1 − μ²), better known than μ tells. */
  sinView: Float
  /** ν, against the sun. */
  cosViewSun: Float
  /** Whether the ground is behind. */
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
  const elevation = elevationPosition(eye, cosView, hitsGround, sinView).toConst() as Float
  const fetch = tileReader(uniforms, eye, cosView, cosViewSun, elevation, hitsGround, sinView)
  // The slice before the ground's ends where the air does.
  const tile = float(SKY_TILE - 1) as Float
  const mean = meanExtinction(textures.depth, eye, elevation, hitsGround, float(1))
  return {
    molecular: fetch(textures.molecular, tile),
    aerosol: fetch(textures.aerosol, tile),
    depth: mean.mul(length)
  }
}

/** Transmittance of all the air in a direction; 1 where there is none. */
export function skyTransmittance(
  uniforms: AtmosphereUniforms,
  textures: VolumeTextures,
  eye: Eye,
  cosView: Float,
  hitsGround: Bool
): Vec4 {
  const elevation = elevationPosition(eye, cosView, hitsGround)
  const { length } = rayLimits(uniforms, eye, cosView, hitsGround)
  const mean = meanExtinction(textures.depth, eye, elevation, hitsGround, float(1))
  return mean.mul(length).negate().exp()
}
