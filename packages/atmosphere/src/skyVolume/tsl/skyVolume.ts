import { float, vec2 } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import type { Texels } from '../../tables/TableAtlas'
import { LIGHT_LENGTH, RADIANCE_SCALE, VOLUME_SIZE, VOLUME_TILES } from '../../tables/tableSizes'
import type { Float, Vec2, Vec4 } from '../../tsl-types'
import type { Viewpoint } from '../../view/tsl/viewpoint'
import { miePhase } from '../../air/tsl/phase'
import { rowAndColumn } from '../../tables/tsl/texels'
import type { RayLimits } from './rayLimits'
import { EXTINCTION_SCALE, meanExtinction } from './meanExtinction'
import { viewRay, type ViewRay } from './viewRay'
import { azimuthColumn, elevationTexel, slicePosition } from './volumeMapping'

const [AZIMUTHS, ELEVATIONS, DISTANCES] = VOLUME_SIZE
const [TILE_COLUMNS] = VOLUME_TILES

/** Number of the tile that holds all the air along a ray and the ground behind it. */
export const SKY_TILE = DISTANCES

/** Medium between the viewpoint and a point: the light that it adds, and its optical depth. */
export interface MediumSegment {
  /** Light added, for unit irradiance of the source [1/sr]; of layers over `solarIrradiance` [1/sr]. */
  radiance: Vec4
  /** Optical depth; in front of the sky that of layers alone. */
  depth: Vec4
}

/** Texel of the atlas of a direction in a tile, of the light by molecules. */
function tileReader(
  uniforms: AtmosphereUniforms,
  viewpoint: Viewpoint,
  { cosView, sinView, hitsGround, elevation }: ViewRay,
  cosViewLight: Float
): (tile: Float) => Vec2 {
  const row = elevationTexel(elevation, hitsGround, ELEVATIONS)
  const column = azimuthColumn(uniforms, viewpoint, cosView, sinView, cosViewLight, hitsGround)
  const first = vec2(column, row).add(viewpoint.lightOrigin).toConst()
  return tile => {
    const { row: tileRow, column: tileColumn } = rowAndColumn(tile, TILE_COLUMNS)
    return vec2(tileColumn, tileRow).mul(vec2(AZIMUTHS, ELEVATIONS)).add(first).toConst()
  }
}

/** Part of a view ray up to a point, as the sky volumes of its viewpoint have it. */
export interface VolumeSegment extends ViewRay {
  /** Position among the distances of its ray, in [0, 1]. */
  position: Float
  /** Optical depth up to it. */
  depth: Vec4
  /** Distance in the air up to it [m]. */
  inAir: Float
}

/**
 * @param cosView - μ, ray against the zenith of the viewpoint.
 * @param limits - Limits of the same ray.
 * @param distance - Distance from the viewpoint [m].
 */
export function volumeSegment(
  atlas: Texels,
  viewpoint: Viewpoint,
  cosView: Float,
  limits: RayLimits,
  distance: Float
): VolumeSegment {
  const { hitsGround, length } = limits
  const ray = viewRay(viewpoint, cosView, hitsGround)
  const inAir = distance.sub(limits.start).clamp(0, length).toConst() as Float
  const position = slicePosition(viewpoint, limits, inAir).toConst() as Float
  const mean = meanExtinction(atlas, viewpoint, ray, position)
  return { ...ray, position, inAir, depth: mean.mul(inAir.div(EXTINCTION_SCALE)).toConst() }
}

/** Reads the light of the air between the viewpoint and a point from the volume, for unit irradiance [1/sr]. */
export function radianceBetween(
  uniforms: AtmosphereUniforms,
  atlas: Texels,
  viewpoint: Viewpoint,
  segment: VolumeSegment,
  cosViewLight: Float
): Vec4 {
  const fetch = tileReader(uniforms, viewpoint, segment, cosViewLight)
  // Slice k ends at (k + 1)/N: before the first the line through the first two goes on.
  const slice = segment.position.mul(DISTANCES).sub(1).toConst()
  const near = slice
    .floor()
    .clamp(0, DISTANCES - 2)
    .toConst() as Float
  const phase = miePhase(uniforms, cosViewLight).toConst()
  const [from, to] = [near, near.add(1)].map(tile => readTile(atlas, fetch(tile), phase))
  const light = from.add(to.sub(from).mul(slice.sub(near))).max(0)
  return light.mul(segment.inAir.mul(1 / (LIGHT_LENGTH * RADIANCE_SCALE)))
}

/** Adds both parts, times the table's scale. */
function readTile(atlas: Texels, texel: Vec2, phase: Vec4): Vec4 {
  const aside = vec2(AZIMUTHS * TILE_COLUMNS, 0)
  const aerosol = atlas.at(texel.add(aside)).mul(phase)
  return aerosol.add(atlas.at(texel))
}

/**
 * Reads the air between the viewpoint and a point from the volume.
 *
 * @param cosView - μ, ray against the zenith of the viewpoint.
 * @param cosViewLight - ν, ray against the light.
 * @param limits - Limits of the same ray.
 * @param distance - Distance from the viewpoint [m].
 */
export function sampleVolume(
  uniforms: AtmosphereUniforms,
  atlas: Texels,
  viewpoint: Viewpoint,
  cosView: Float,
  cosViewLight: Float,
  limits: RayLimits,
  distance: Float
): MediumSegment {
  const segment = volumeSegment(atlas, viewpoint, cosView, limits, distance)
  return {
    radiance: radianceBetween(uniforms, atlas, viewpoint, segment, cosViewLight),
    depth: segment.depth
  }
}

/**
 * Reads the light of all the air in a direction and of the ground behind it from the volume, for unit
 * irradiance [1/sr].
 *
 * @param ray - View ray, which meets the air.
 * @param cosViewLight - ν, direction against the light.
 */
export function sampleSky(
  uniforms: AtmosphereUniforms,
  atlas: Texels,
  viewpoint: Viewpoint,
  ray: ViewRay,
  cosViewLight: Float
): Vec4 {
  const at = tileReader(uniforms, viewpoint, ray, cosViewLight)(float(SKY_TILE))
  return readTile(atlas, at, miePhase(uniforms, cosViewLight)).mul(1 / RADIANCE_SCALE)
}

/** View ray through all of the air. */
export interface AirRay extends Omit<ViewRay, 'elevation'> {
  /** ν, against the source of light. */
  cosViewLight: Float
  /** Length through the air, to the ground or out of it [m]. */
  length: Float
}

/** Reads all the air along a view ray from the volume, without what is behind it: 3 fetches. */
export function sampleAir(
  uniforms: AtmosphereUniforms,
  atlas: Texels,
  viewpoint: Viewpoint,
  { cosView, sinView, cosViewLight, hitsGround, length }: AirRay
): MediumSegment {
  const ray = viewRay(viewpoint, cosView, hitsGround, sinView)
  // The slice before the ground's ends where the air does.
  const at = tileReader(uniforms, viewpoint, ray, cosViewLight)(float(SKY_TILE - 1))
  const mean = meanExtinction(atlas, viewpoint, ray, float(1))
  const light = readTile(atlas, at, miePhase(uniforms, cosViewLight))
  const part = length.mul(1 / (LIGHT_LENGTH * RADIANCE_SCALE))
  return { radiance: light.mul(part), depth: mean.mul(length.div(EXTINCTION_SCALE)) }
}
