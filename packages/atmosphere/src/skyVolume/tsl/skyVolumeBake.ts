import { Discard, Fn, If, float, int, outputStruct, property, uv, vec2, vec4 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import type { TwoOutputs } from '../../tables/FragmentPass'
import {
  DEPTH_SIZE,
  RADIANCE_SCALE,
  VOLUME_SIZE,
  VOLUME_SLOTS,
  VOLUME_TILES
} from '../../tables/tableSizes'
import { loop, sampleLevel0, type Float, type Vec2, type Vec4 } from '../../tsl-types'
import type { Eye } from '../../view/tsl/eye'
import {
  groundRadiance,
  pointAlong,
  scatterSegment,
  segmentDepth,
  type Air,
  type Ray
} from '../../scattering/tsl/scattering'
import {
  EXTINCTION_SCALE,
  SKY_TILE,
  columnCosine,
  meanExtinction,
  rayLimits,
  rowCosine,
  sliceDistance,
  type RayLimits
} from './skyVolume'
import { rowAndColumn } from '../../tables/tsl/texels'

const [AZIMUTHS, ELEVATIONS, DISTANCES] = VOLUME_SIZE
const [TILE_COLUMNS, TILE_ROWS] = VOLUME_TILES
const [DEPTH_COLUMNS, DEPTH_ROWS] = DEPTH_SIZE

/** Values for the two attachments of a target. */
interface Parts {
  molecular: Vec4
  aerosol: Vec4
}

function twoOutputs(body: () => Parts): TwoOutputs {
  const first = property('vec4') as unknown as Vec4
  const second = property('vec4') as unknown as Vec4
  const assign = Fn(() => {
    const { molecular, aerosol } = body()
    first.assign(molecular)
    second.assign(aerosol)
    return vec4(0)
  })
  return { color: assign(), output: outputStruct(first, second) }
}

/** The same ray from where it enters the air. */
export function enterAir(air: Air, ray: Ray, limits: RayLimits): Ray {
  const { thickness } = air.uniforms
  const entry = pointAlong(air, ray, limits.start)
  return {
    altitude: limits.start
      .greaterThan(0)
      .select(thickness, entry.altitude.min(thickness))
      .toConst(),
    cosView: entry.cosView,
    cosSun: entry.cosSun,
    cosViewSun: ray.cosViewSun
  }
}

/** Texture coordinates within the eye's part of a target; fragments elsewhere are discarded. */
function withinSlot(eye: Eye): Vec2 {
  const texel = uv() as Vec2
  const y = texel.y.mul(VOLUME_SLOTS).sub(eye.slot).toConst()
  If(y.lessThan(0).or(y.greaterThan(1)), () => {
    Discard()
  })
  return vec2(texel.x, y).toConst()
}

/**
 * Shader of the table of mean extinction: rows are elevations, columns distances; the last column has the
 * transmittance of all the way.
 */
export function bakeDepth(air: Air, eye: Eye): Vec4 {
  return Fn(() => {
    const texel = withinSlot(eye)
    const { cosView, hitsGround } = rowCosine(eye, texel.y.mul(DEPTH_ROWS), DEPTH_ROWS)
    const limits = rayLimits(eye, cosView, hitsGround)
    const { altitude, cosSun } = eye
    const ray = enterAir(air, { altitude, cosView, cosSun, cosViewSun: cosSun }, limits)
    const start = float(0).toVar()
    const depth = vec4(0).toVar()
    const column = texel.x
      .mul(DEPTH_COLUMNS + 1)
      .floor()
      .toConst()
    loop('segment', int(column.add(1).min(DEPTH_COLUMNS)), segment => {
      const position = float(segment).add(1).div(DEPTH_COLUMNS)
      const end = sliceDistance(eye, limits, position).toConst()
      depth.addAssign(segmentDepth(air, ray, start, end).depth)
      start.assign(end)
    })
    const isLast = column.greaterThanEqual(DEPTH_COLUMNS)
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
 * the eye; and the last tile with the light of the ground.
 *
 * @param depth - Table of {@link bakeDepth} for the same eye.
 */
export function bakeSegments(air: Air, eye: Eye, depth: TextureNode): TwoOutputs {
  return twoOutputs(() => {
    const { column, row, slice } = atlasPosition(uv())
    const { cosView, hitsGround, position } = rowCosine(eye, row, ELEVATIONS)
    const limits = rayLimits(eye, cosView, hitsGround)
    const cosViewSun = columnCosine(air.uniforms, eye, cosView, column, hitsGround)
    const { altitude, cosSun } = eye
    const ray = enterAir(air, { altitude, cosView, cosSun, cosViewSun }, limits)
    const start = sliceDistance(eye, limits, slice.div(DISTANCES)).toConst() as Float
    const end = sliceDistance(eye, limits, slice.add(1).div(DISTANCES)).toConst() as Float
    const reached = slice.div(DISTANCES) as Float
    const before = meanExtinction(depth, eye, { elevation: position, hitsGround }, reached)
    const through = before.mul(start.div(EXTINCTION_SCALE)).negate().exp().toConst()
    const molecular = vec4(0).toVar()
    const aerosol = vec4(0).toVar()
    If(slice.lessThan(SKY_TILE), () => {
      const light = scatterSegment(air, ray, start, end, { sun: true, diffuse: true })
      molecular.assign(light.molecular.mul(through))
      aerosol.assign(light.aerosol.mul(through))
    }).ElseIf(hitsGround, () => {
      const foot = pointAlong(air, ray, limits.length)
      molecular.assign(groundRadiance(air, foot.cosSun).mul(through).mul(RADIANCE_SCALE))
    })
    return { molecular: molecular, aerosol: aerosol }
  })
}

/** Shader that sums the segments up to each slice. */
export function sumSegments(eye: Eye, molecular: TextureNode, aerosol: TextureNode): TwoOutputs {
  return twoOutputs(() => {
    const { column, row, slice } = atlasPosition(withinSlot(eye))
    const sums = { molecular: vec4(0).toVar(), aerosol: vec4(0).toVar() }
    const size = vec2(1 / (AZIMUTHS * TILE_COLUMNS), 1 / (ELEVATIONS * TILE_ROWS))
    loop('before', int(slice).add(1), index => {
      const tile = rowAndColumn(float(index).toConst(), TILE_COLUMNS)
      const corner = vec2(tile.column.mul(AZIMUTHS), tile.row.mul(ELEVATIONS))
      const at = vec2(column, row).add(corner).add(0.5).mul(size).toConst() as Vec2
      sums.molecular.addAssign(sampleLevel0(molecular, at))
      sums.aerosol.addAssign(sampleLevel0(aerosol, at))
    })
    return sums
  })
}
