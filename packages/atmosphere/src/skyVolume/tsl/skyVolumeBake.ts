import { Fn, If, float, int, uv, vec2, vec4 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { outputs, type Outputs } from '../../tables/FragmentPass'
import type { Texels } from '../../tables/TableAtlas'
import {
  DEPTH_SIZE,
  LIGHT_LENGTH,
  RADIANCE_SCALE,
  VOLUME_SIZE,
  VOLUME_TILES
} from '../../tables/tableSizes'
import { loop, sampleLevel0, type Float, type Vec2, type Vec4 } from '../../tsl-types'
import type { Viewpoint } from '../../view/tsl/viewpoint'
import { groundRadiance } from '../../scattering/tsl/scattering'
import { pointAlong, type Air, type Ray } from '../../scattering/tsl/ray'
import { scatterSegment, segmentDepth } from '../../scattering/tsl/segment'
import { EXTINCTION_SCALE, meanExtinction } from './meanExtinction'
import { SKY_TILE } from './skyVolume'
import { columnCosine, elevationCosine, sliceDistance } from './volumeMapping'
import { rayLimits, type RayLimits } from './rayLimits'
import { rowAndColumn } from '../../tables/tsl/texels'

const [AZIMUTHS, ELEVATIONS, DISTANCES] = VOLUME_SIZE
const [TILE_COLUMNS, TILE_ROWS] = VOLUME_TILES
const [DEPTH_ELEVATIONS, DEPTH_DISTANCES] = DEPTH_SIZE

/** Light that half floats hold. */
const MOST_HALF = 65_000

/** Ray from where it enters the air. */
export function enterAir(air: Air, ray: Ray, limits: RayLimits): Ray {
  const { thickness } = air.uniforms
  const entry = pointAlong(air, ray, limits.start)
  return {
    altitude: limits.start
      .greaterThan(0)
      .select(thickness, entry.altitude.min(thickness))
      .toConst(),
    cosView: entry.cosView,
    cosLight: entry.cosLight,
    cosViewLight: ray.cosViewLight
  }
}

/**
 * Shader of the table of mean extinction: columns are elevations, rows distances; the last row has the transmittance of the whole ray.
 */
export function bakeDepth(air: Air, viewpoint: Viewpoint): Vec4 {
  return Fn(() => {
    const texel = uv() as Vec2
    const column = texel.x.mul(DEPTH_ELEVATIONS)
    const { cosView, hitsGround } = elevationCosine(viewpoint, column, DEPTH_ELEVATIONS)
    const limits = rayLimits(viewpoint, cosView, hitsGround)
    const { altitude, cosLight } = viewpoint
    const ray = enterAir(air, { altitude, cosView, cosLight, cosViewLight: cosLight }, limits)
    const start = float(0).toVar()
    const depth = vec4(0).toVar()
    const row = texel.y
      .mul(DEPTH_DISTANCES + 1)
      .floor()
      .toConst()
    loop('segment', int(row.add(1).min(DEPTH_DISTANCES)), segment => {
      const position = float(segment).add(1).div(DEPTH_DISTANCES)
      const end = sliceDistance(viewpoint, limits, position).toConst()
      depth.addAssign(segmentDepth(air, ray, start, end).depth)
      start.assign(end)
    })
    const isLast = row.greaterThanEqual(DEPTH_DISTANCES)
    const mean = depth.div(start.max(1)).mul(EXTINCTION_SCALE)
    return isLast.select(depth.negate().exp(), mean)
  })()
}

/** Position of a texel in the atlas of slices. */
function atlasPosition(texel: Vec2) {
  const x = texel.x
    .mul(AZIMUTHS * TILE_COLUMNS)
    .floor()
    .toConst()
  const y = texel.y
    .mul(ELEVATIONS * TILE_ROWS)
    .floor()
    .toConst()
  const { row: tileColumn, column } = rowAndColumn(x, AZIMUTHS)
  const { row: tileRow, column: row } = rowAndColumn(y, ELEVATIONS)
  return {
    column,
    row,
    slice: tileRow.mul(TILE_COLUMNS).add(tileColumn).toConst() as Float
  }
}

/**
 * Shader that fills the atlas with the light scattered between one slice and the next, as seen from
 * the viewpoint; and the last tile with the light of the ground.
 *
 * @param atlas - Has the table of {@link bakeDepth} for the same viewpoint.
 */
export function bakeSegments(air: Air, viewpoint: Viewpoint, atlas: Texels): Outputs {
  return outputs<[Vec4, Vec4]>(2, ([molecular, aerosol]) => {
    const { column, row, slice } = atlasPosition(uv())
    const { cosView, hitsGround, position } = elevationCosine(viewpoint, row, ELEVATIONS)
    const limits = rayLimits(viewpoint, cosView, hitsGround)
    const cosViewLight = columnCosine(air.uniforms, viewpoint, cosView, column, hitsGround)
    const { altitude, cosLight } = viewpoint
    const ray = enterAir(air, { altitude, cosView, cosLight, cosViewLight }, limits)
    const start = sliceDistance(viewpoint, limits, slice.div(DISTANCES)).toConst() as Float
    const end = sliceDistance(viewpoint, limits, slice.add(1).div(DISTANCES)).toConst() as Float
    const reached = slice.div(DISTANCES) as Float
    const before = meanExtinction(atlas, viewpoint, { elevation: position, hitsGround }, reached)
    const through = before.mul(start.div(EXTINCTION_SCALE)).negate().exp().toConst()
    molecular.assign(vec4(0))
    aerosol.assign(vec4(0))
    If(slice.lessThan(SKY_TILE), () => {
      const light = scatterSegment(air, ray, start, end, { direct: true, diffuse: true })
      molecular.assign(light.molecular.mul(through))
      aerosol.assign(light.aerosol.mul(through))
    }).ElseIf(hitsGround, () => {
      const { cosLight } = pointAlong(air, ray, limits.length)
      molecular.assign(groundRadiance(air, cosLight).mul(through).mul(RADIANCE_SCALE))
    })
  })
}

/**
 * Shader that sums the segments up to each slice: light per {@link LIGHT_LENGTH}, but the last tile's light as it is.
 *
 * @param molecular - First output of {@link bakeSegments}: its sums are the left half.
 * @param aerosol - Second output: the right half.
 */
export function sumSegments(
  viewpoint: Viewpoint,
  molecular: TextureNode,
  aerosol: TextureNode
): Vec4 {
  return Fn(() => {
    const across = uv().x.mul(2).toConst()
    const { column, row, slice } = atlasPosition(vec2(across.fract(), uv().y))
    const sum = vec4(0).toVar()
    const size = vec2(1 / (AZIMUTHS * TILE_COLUMNS), 1 / (ELEVATIONS * TILE_ROWS))
    loop('before', int(slice).add(1), index => {
      const tile = rowAndColumn(float(index).toConst(), TILE_COLUMNS)
      const x = tile.column.mul(AZIMUTHS).add(column)
      const y = tile.row.mul(ELEVATIONS).add(row)
      const at = vec2(x, y).add(0.5).mul(size).toConst() as Vec2
      const [left, right] = [molecular, aerosol].map(half => sampleLevel0(half, at))
      sum.addAssign(across.lessThan(1).select(left, right))
    })
    const { cosView, hitsGround } = elevationCosine(viewpoint, row, ELEVATIONS)
    const limits = rayLimits(viewpoint, cosView, hitsGround)
    const distance = sliceDistance(viewpoint, limits, slice.add(1).div(DISTANCES))
    const part = float(LIGHT_LENGTH).div(distance.max(1e-3))
    return sum.mul(slice.lessThan(SKY_TILE).select(part, 1)).min(MOST_HALF)
  })()
}
