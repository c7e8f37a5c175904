import { float, mix, vec2 } from 'three/tsl'
import type { Node, TextureNode } from 'three/webgpu'
import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import { DEPTH_COLUMNS, VOLUME_SIZE, VOLUME_SLOTS, VOLUME_TILES } from '../tableSizes'
import { sampleLevel0, type Bool, type Float, type Vec2, type Vec4 } from '../tsl-types'
import { distanceToGround, groundDiscriminant } from './boundary'
import type { Eye } from './eye'
import type { Scattered } from './scattering'

const [AZIMUTHS, ELEVATIONS, DISTANCES] = VOLUME_SIZE
const [TILE_COLUMNS, TILE_ROWS] = VOLUME_TILES
const HALF = ELEVATIONS / 2

/** Textures of a sky volume. */
export interface VolumeTextures {
  /** Light scattered by molecules, and by aerosols more than once. */
  molecular: TextureNode
  /** Light scattered by aerosols once, without its phase function. */
  aerosol: TextureNode
  /** Optical depth. */
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
  const gap = thickness
    .sub(eye.altitude)
    .mul(bottomRadius.mul(2).add(thickness).add(eye.altitude))
  const halfChord = radial.mul(radial).add(gap).max(0).sqrt().toConst()
  const start = radial.negate().sub(halfChord).max(0).toConst()
  const top = halfChord.sub(radial).max(0)
  const hitsGround =
    forcedGround ?? (ground.greaterThanEqual(0).and(cosView.lessThan(0)).toConst() as Bool)
  const bottom = distanceToGround(eye.altitude, cosView, ground, bottomRadius)
  return {
    start: start as Float,
    length: hitsGround.select(bottom, top).sub(start).max(0).toConst() as Float,
    hitsGround
  }
}

/**
 * Row of an elevation, in texels: √tan(α/2), α from the horizon, in either half.
 *
 * @param cosView - μ, ray against the zenith of the eye.
 * @param hitsGround - Which half.
 */
function elevationRow(eye: Eye, cosView: Float, hitsGround: Node<'bool'>): Float {
  const sinView = cosView.mul(cosView).oneMinus().max(0).sqrt().toConst()
  const sine = cosView.mul(eye.sinHorizon).sub(sinView.mul(eye.cosHorizon)).abs()
  const cosine = sinView.mul(eye.sinHorizon).add(cosView.mul(eye.cosHorizon))
  const span = hitsGround.select(eye.belowSpan, eye.aboveSpan)
  const position = sine.div(cosine.add(1).max(1e-6)).div(span).clamp().sqrt()
  return position.mul(HALF - 1).add(hitsGround.select(0.5, HALF + 0.5)) as Float
}

/** Cosine of the zenith angle of a row, the inverse of {@link elevationRow}. */
export function rowCosine(eye: Eye, row: Float): { cosView: Float; hitsGround: Bool } {
  const hitsGround = row.lessThan(HALF).toConst()
  const position = row.sub(hitsGround.select(0, HALF)).floor().div(HALF - 1).toConst()
  const span = hitsGround.select(eye.belowSpan, eye.aboveSpan)
  const tangent = position.mul(position).mul(span).toConst()
  const square = tangent.mul(tangent).toConst()
  const sine = tangent.mul(hitsGround.select(-2, 2))
  const cosView = eye.cosHorizon
    .mul(square.oneMinus())
    .add(eye.sinHorizon.mul(sine))
    .div(square.add(1))
    .clamp(-1, 1)
  return { cosView: cosView.toConst() as Float, hitsGround: hitsGround as Bool }
}

/**
 * Column of an azimuth φ from the sun, in texels: sin(φ/2) = √((1 − cos φ)/2).
 *
 * @param cosView - μ.
 * @param cosViewSun - ν.
 */
function azimuthColumn(eye: Eye, cosView: Float, cosViewSun: Float): Float {
  const sines = cosView
    .mul(cosView)
    .oneMinus()
    .mul(eye.cosSun.mul(eye.cosSun).oneMinus())
    .max(1e-12)
    .sqrt()
  const cosAzimuth = cosViewSun.sub(cosView.mul(eye.cosSun)).div(sines).clamp(-1, 1)
  return cosAzimuth
    .oneMinus()
    .mul(0.5)
    .sqrt()
    .mul(AZIMUTHS - 1)
    .add(0.5) as Float
}

/** ν of a column, the inverse of {@link azimuthColumn}. */
export function columnCosine(eye: Eye, cosView: Float, column: Float): Float {
  const sine = column.floor().div(AZIMUTHS - 1)
  const cosAzimuth = sine.mul(sine).mul(2).oneMinus()
  const sines = cosView
    .mul(cosView)
    .oneMinus()
    .mul(eye.cosSun.mul(eye.cosSun).oneMinus())
    .max(0)
    .sqrt()
  return cosView.mul(eye.cosSun).add(sines.mul(cosAzimuth)).clamp(-1, 1).toConst() as Float
}

const exponentOf = (eye: Eye, hitsGround: Bool): Float =>
  hitsGround.select(eye.groundExponent, eye.skyExponent).toConst() as Float

/** Distance along a ray at a position x in [0, 1] among the slices [m]. */
export function sliceDistance(eye: Eye, limits: RayLimits, position: Float): Float {
  const exponent = exponentOf(eye, limits.hitsGround)
  return exponent
    .mul(position)
    .exp()
    .sub(1)
    .div(exponent.exp().sub(1))
    .mul(limits.length) as Float
}

/** Position among the slices of a distance, the inverse of {@link sliceDistance}. */
function slicePosition(eye: Eye, limits: RayLimits, distance: Float): Float {
  const exponent = exponentOf(eye, limits.hitsGround)
  const part = distance.div(limits.length.max(1e-3)).clamp()
  return part.mul(exponent.exp().sub(1)).add(1).log().div(exponent).clamp() as Float
}

/** Where the table of optical depth keeps a column and row, in texels. */
export function depthUV(eye: Eye, column: Float, row: Float): Vec2 {
  const rowInTable = row.add(eye.slot.mul(ELEVATIONS))
  return vec2(column.div(DEPTH_COLUMNS), rowInTable.div(ELEVATIONS * VOLUME_SLOTS)) as Vec2
}

/** Light scattered between the eye and a point, with the optical depth between them. */
export interface AirBetween extends Scattered {
  depth: Vec4
}

/**
 * Reads the volume.
 *
 * @param cosView - μ, ray against the zenith of the eye.
 * @param cosViewSun - ν, ray against sun.
 * @param limits - Of the same ray.
 * @param distance - From the eye; null for the whole ray [m].
 */
export function sampleVolume(
  textures: VolumeTextures,
  eye: Eye,
  cosView: Float,
  cosViewSun: Float,
  limits: RayLimits,
  distance: Float | null
): AirBetween {
  const row = elevationRow(eye, cosView, limits.hitsGround).toConst() as Float
  const column = azimuthColumn(eye, cosView, cosViewSun)
  const inTile = vec2(column, row).toConst() as Vec2
  const atlas = vec2(
    1 / (AZIMUTHS * TILE_COLUMNS),
    1 / (ELEVATIONS * TILE_ROWS * VOLUME_SLOTS)
  )
  const fetch = (source: TextureNode, slice: Float): Vec4 => {
    const tileRow = slice.div(TILE_COLUMNS).floor()
    const corner = vec2(
      slice.sub(tileRow.mul(TILE_COLUMNS)).mul(AZIMUTHS),
      tileRow.add(eye.slot.mul(TILE_ROWS)).mul(ELEVATIONS)
    )
    return sampleLevel0(source, inTile.add(corner).mul(atlas) as Vec2)
  }
  const depthAt = (column: Float): Vec4 =>
    sampleLevel0(textures.depth, depthUV(eye, column, row))

  const exists = limits.length.greaterThan(0).select(1, 0)
  if (distance === null) {
    const last = float(DISTANCES - 1) as Float
    return {
      molecular: fetch(textures.molecular, last).mul(exists) as Vec4,
      aerosol: fetch(textures.aerosol, last).mul(exists) as Vec4,
      depth: depthAt(float(DEPTH_COLUMNS - 0.5) as Float).mul(exists) as Vec4
    }
  }
  const position = slicePosition(eye, limits, distance.sub(limits.start).max(0) as Float).toConst()
  // Slice k ends at (k + 1)/N: before the first everything grows from nothing.
  const grown = position.mul(DISTANCES).min(1).mul(exists).toConst()
  const slice = position.mul(DISTANCES).sub(1).max(0).toConst()
  const near = slice.floor().min(DISTANCES - 2).toConst() as Float
  const far = near.add(1) as Float
  const part = slice.sub(near)
  const read = (source: TextureNode): Vec4 =>
    mix(fetch(source, near), fetch(source, far), part).mul(grown) as Vec4
  const depthPosition = position.mul(DEPTH_COLUMNS).toConst()
  const depth = depthAt(depthPosition.max(1).sub(0.5) as Float)
  return {
    molecular: read(textures.molecular),
    aerosol: read(textures.aerosol),
    depth: depth.mul(depthPosition.min(1)).mul(exists) as Vec4
  }
}

