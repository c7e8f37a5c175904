import { Discard, Fn, If, float, int, mix, uv, vec2, vec4 } from 'three/tsl'
import type { Node, TextureNode } from 'three/webgpu'
import { diffuseSunOrigin, diffuseSunSlope } from '../cpu/diffuseLight'
import { DIFFUSE_SIZE, DIFFUSE_TILES, RADIANCE_SCALE } from '../../tables/tableSizes'
import {
  loop,
  sampleLevel0,
  type Float,
  type Int,
  type Vec2,
  type Vec4,
  type Vec4Array
} from '../../tsl-types'
import { distanceToGround, distanceToTop, groundDiscriminant } from '../../air/tsl/boundary'
import { spreadCosine } from './diffuseLight'
import { SH0, SH1, SH20, SH21, SH22 } from './moments'
import {
  groundRadiance,
  pointAlong,
  scatteredRadiance,
  scattering,
  type Air
} from '../../scattering/tsl/scattering'
import { rowAndColumn } from '../../tables/tsl/texels'
import { sine } from '../../math/tsl/trigonometry'

const [COLUMNS, ROWS] = DIFFUSE_SIZE

/** Rows of the table that one pass over the rays covers. */
export const BAKE_ROWS = 4

/** Lowest altitude that rays are sent out from: on the ground itself the horizon has no width [m]. */
const LOWEST_ALTITUDE = 1

/** Nearest to the zenith that the sun gets, so that moments can be divided by sin θ_s. */
const HIGHEST_SUN = 0.9998

/** Directions that light is gathered from: their number, and the quadrature rule of elevations. */
export interface Directions {
  /** Nodes above and below the horizon each. */
  elevations: Int
  /** Nodes over half a turn. */
  azimuths: Int
  /** (x, weight, ·, ·) per elevation, the Gauss–Legendre rule on [0, 1]. */
  rule: Vec4Array
  /** Index of the first entry of the rule. */
  offset: Int
}

/** Part of the spacing of elevations that is even; the rest crowds at the horizon. */
const EVEN_SPACING = 0.3

/** Altitude and sun of a cell, from its row (a float counted from the ground) and column. */
function cell(air: Air, row: Float, column: Float) {
  const { thickness } = air.uniforms
  const rowPosition = row.div(ROWS - 1).toConst()
  const altitude = thickness.mul(rowPosition).mul(rowPosition).max(LOWEST_ALTITUDE)
  const x = column
    .div(COLUMNS - 1)
    .div(diffuseSunSlope)
    .add(diffuseSunOrigin)
    .toConst()
  const cosSun = spreadCosine(x)
  return {
    altitude: altitude.toConst() as Float,
    cosSun: cosSun.min(HIGHEST_SUN).toConst() as Float
  }
}

/** Direction of a ray from a cell, by its number, with the solid angle that it stands for. */
function direction(air: Air, altitude: Float, cosSun: Float, number: Int, at: Directions) {
  const { bottomRadius } = air.uniforms
  const elevationIndex = number.div(at.azimuths).toConst()
  const up = elevationIndex.lessThan(at.elevations).toConst()
  const ruleIndex = up.select(elevationIndex, elevationIndex.sub(at.elevations)).add(at.offset)
  const entry = at.rule.element(ruleIndex).toConst()
  const azimuthIndex = number.sub(elevationIndex.mul(at.azimuths))
  const azimuth = float(azimuthIndex).add(0.5).div(float(at.azimuths)).mul(Math.PI)

  const dip = bottomRadius.div(bottomRadius.add(altitude)).acos().toConst()
  const span = up.select(dip.add(Math.PI / 2), float(Math.PI / 2).sub(dip)).toConst()
  const x = entry.x.toConst()
  const fromHorizon = span.mul(x.mul(EVEN_SPACING).add(x.mul(x).mul(1 - EVEN_SPACING)))
  const elevation = up.select(fromHorizon, fromHorizon.negate()).sub(dip).toConst()
  const cosElevation = elevation.cos().toConst()
  const spacing = span.mul(x.mul(2 * (1 - EVEN_SPACING)).add(EVEN_SPACING)).mul(entry.y)
  const solidAngle = spacing
    .mul(cosElevation)
    .mul(2 * Math.PI)
    .div(float(at.azimuths))
  const cosView = elevation.sin().toConst()
  const towardsSun = cosElevation.mul(azimuth.cos()).toConst()
  const cosViewSun = towardsSun.mul(sine(cosSun)).add(cosView.mul(cosSun)).clamp(-1, 1)
  return {
    up: up as Node<'bool'>,
    cosView: cosView as Float,
    towardsSun: towardsSun as Float,
    cosElevation: cosElevation as Float,
    cosViewSun: cosViewSun.toConst() as Float,
    solidAngle: solidAngle as Float
  }
}

/**
 * Shader of the first pass: a texel is a ray, a column its direction, a row its cell.
 *
 * @param firstRow - Row of the table that the target's first cells belong to.
 * @param width - Of the target: the most rays per cell.
 * @param steps - Of the march.
 * @returns Radiance, times `RADIANCE_SCALE`, of the light scattered last in the air or by the ground.
 */
export function bakeRays(
  air: Air,
  at: Directions,
  firstRow: Int,
  width: number,
  steps: number
): Vec4 {
  const lights = { sun: air.diffuse === null, diffuse: air.diffuse !== null }
  const { uniforms } = air
  return Fn(() => {
    const texel = uv() as Vec2
    const number = int(texel.x.mul(width).floor()).toConst() as Int
    If(number.greaterThanEqual(at.elevations.mul(at.azimuths).mul(2)), () => {
      Discard()
    })
    const cellIndex = texel.y
      .mul(BAKE_ROWS * COLUMNS)
      .floor()
      .toConst()
    const { row, column } = rowAndColumn(cellIndex, COLUMNS)
    const { altitude, cosSun } = cell(air, row.add(float(firstRow)), column)
    const towards = direction(air, altitude, cosSun, number, at)
    const ray = { altitude, cosView: towards.cosView, cosSun, cosViewSun: towards.cosViewSun }

    const { bottomRadius, thickness } = uniforms
    const discriminant = groundDiscriminant(altitude, towards.cosView, bottomRadius)
    const length = towards.up
      .select(
        distanceToTop(altitude, towards.cosView, bottomRadius, thickness),
        distanceToGround(altitude, towards.cosView, discriminant, bottomRadius)
      )
      .toConst() as Float
    const end = towards.up.select(thickness, float(0))
    const way = scattering(air, ray, length, end.sub(altitude), steps, lights)
    const radiance = scatteredRadiance(uniforms, way, towards.cosViewSun)
      .mul(RADIANCE_SCALE)
      .toVar()
    If(towards.up.not(), () => {
      const target = pointAlong(air, ray, length)
      const ground = groundRadiance(air, target.cosSun, lights).mul(RADIANCE_SCALE)
      radiance.addAssign(ground.mul(way.depth.negate().exp()))
    })
    return radiance
  })()
}

/**
 * Shader of the second pass: a texel of the table sums the rays of its cell, weighted by what its
 * tile holds. Texels of other rows are discarded.
 *
 * @param rays - Target of {@link bakeRays}.
 * @param firstRow - Row of the table that the target's first cells belong to.
 * @param width - Of that target.
 */
export function reduceRays(
  air: Air,
  rays: TextureNode,
  at: Directions,
  firstRow: Int,
  width: number
): Vec4 {
  return Fn(() => {
    const texel = uv() as Vec2
    const row = texel.y.mul(ROWS).floor().toConst()
    const rowInTarget = row.sub(float(firstRow)).toConst()
    If(rowInTarget.lessThan(0).or(rowInTarget.greaterThanEqual(BAKE_ROWS)), () => {
      Discard()
    })
    const x = texel.x
      .mul(COLUMNS * DIFFUSE_TILES)
      .floor()
      .toConst()
    const { row: tile, column } = rowAndColumn(x, COLUMNS)
    const { altitude, cosSun } = cell(air, row, column)
    const sinSquaredSun = cosSun.mul(cosSun).oneMinus().toConst()
    const inverseSinSun = sinSquaredSun.inverseSqrt().toConst()
    const y = rowInTarget
      .mul(COLUMNS)
      .add(column)
      .add(0.5)
      .div(BAKE_ROWS * COLUMNS)
      .toConst()

    const sum = vec4(0).toVar()
    loop('ray', at.elevations.mul(at.azimuths).mul(2), ray => {
      const { cosView, towardsSun, cosElevation, solidAngle } = direction(
        air,
        altitude,
        cosSun,
        ray,
        at
      )
      const mu = cosView
      const along = towardsSun.mul(inverseSinSun).toConst()
      const m22 = towardsSun
        .mul(towardsSun)
        .mul(2)
        .sub(cosElevation.mul(cosElevation))
        .div(sinSquaredSun)
      const weights = [
        float(SH0),
        mu.mul(SH1),
        along.mul(SH1),
        mu.mul(mu).mul(3).sub(1).mul(SH20),
        mu.mul(along).mul(SH21),
        m22.mul(SH22),
        mu.max(0),
        mu.negate().max(0)
      ]
      const weight = weights.reduce(
        (chosen, value, i) => mix(chosen, value, tile.equal(i).select(1, 0)) as never
      )
      const source = vec2(float(ray).add(0.5).div(width), y)
      sum.addAssign(sampleLevel0(rays, source).mul(weight).mul(solidAngle))
    })
    return sum
  })()
}

/** Largest ratio of two successive orders of scattering that the tail is summed with. */
const LARGEST_RATIO = 0.95

/**
 * Shader that sums the orders of scattering. Orders after the last are added as a geometric series
 * with the ratio of the last two.
 */
export function sumOrders(orders: TextureNode[]): Vec4 {
  return Fn(() => {
    const texel = uv() as Vec2
    // The ratio of the l = 0 moments of the cell, which are positive.
    const tile = 1 / DIFFUSE_TILES
    const first = vec2(texel.x.sub(texel.x.div(tile).floor().mul(tile)), texel.y).toConst() as Vec2
    const [before, last] = orders.slice(-2).map(order => sampleLevel0(order, first)) as [Vec4, Vec4]
    const ratio = last.div(before.max(1e-7)).clamp(0, LARGEST_RATIO).toConst()
    const lights = orders.map(order => sampleLevel0(order, texel))
    const tail = lights.at(-1)!.mul(ratio.div(ratio.oneMinus()))
    return lights.reduce((sum, light) => sum.add(light) as Vec4).add(tail)
  })()
}
