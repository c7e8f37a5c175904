import { Discard, Fn, If, float, int, mix, uv, vec2, vec4 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { DIFFUSE_LAYOUT, DIFFUSE_SIZE, RADIANCE_SCALE } from '../../tables/tableSizes'
import { loop, sampleLevel0, type Float, type Int, type Vec2, type Vec4 } from '../../tsl-types'
import { distanceToGround, distanceToTop, groundDiscriminant } from '../../air/tsl/boundary'
import { SH0, SH1, SH20, SH21, SH22 } from './moments'
import { groundRadiance, scatteredRadiance, scattering } from '../../scattering/tsl/scattering'
import { pointAlong, type Air } from '../../scattering/tsl/ray'
import type { Table } from '../../tables/TableAtlas'
import { cell, direction, type Directions } from './gatherDirections'
import { rowAndColumn } from '../../tables/tsl/texels'

const [COLUMNS, ROWS] = DIFFUSE_SIZE
const [TILE_COLUMNS, TILE_ROWS] = DIFFUSE_LAYOUT

/** Rows of the table that one pass over the rays covers. */
export const BAKE_ROWS = 4

/**
 * Shader of the first pass: a texel is a ray, a column its direction, a row its cell.
 *
 * @param firstRow - Row of the table that the target's first cells belong to.
 * @param width - Width of the target: the most rays per cell.
 * @param steps - Number of steps of the march.
 * @returns Radiance, times `RADIANCE_SCALE`, of the light scattered last in the air or by the ground.
 */
export function bakeRays(
  air: Air,
  at: Directions,
  firstRow: Int,
  width: number,
  steps: number
): Vec4 {
  const lights = { direct: air.diffuse === null, diffuse: air.diffuse !== null }
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
    const { altitude, cosLight } = cell(air, row.add(float(firstRow)), column)
    const towards = direction(air, altitude, cosLight, number, at)
    const ray = { altitude, cosView: towards.cosView, cosLight, cosViewLight: towards.cosViewLight }

    const { bottomRadius, thickness } = uniforms
    const discriminant = groundDiscriminant(altitude, towards.cosView, bottomRadius)
    const length = towards.up
      .select(
        distanceToTop(altitude, towards.cosView, bottomRadius, thickness),
        distanceToGround(altitude, towards.cosView, discriminant, bottomRadius)
      )
      .toConst() as Float
    const end = towards.up.select(thickness, float(0))
    const scattered = scattering(air, ray, length, end.sub(altitude), steps, lights)
    const radiance = scatteredRadiance(uniforms, scattered, towards.cosViewLight)
      .mul(RADIANCE_SCALE)
      .toVar()
    If(towards.up.not(), () => {
      const target = pointAlong(air, ray, length)
      const ground = groundRadiance(air, target.cosLight, lights).mul(RADIANCE_SCALE)
      radiance.addAssign(ground.mul(scattered.depth.negate().exp()))
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
 * @param width - Width of that target.
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
    const y = texel.y
      .mul(ROWS * TILE_ROWS)
      .floor()
      .toConst()
    const { row: tileRow, column: row } = rowAndColumn(y, ROWS)
    const rowInTarget = row.sub(float(firstRow)).toConst()
    If(rowInTarget.lessThan(0).or(rowInTarget.greaterThanEqual(BAKE_ROWS)), () => {
      Discard()
    })
    const x = texel.x
      .mul(COLUMNS * TILE_COLUMNS)
      .floor()
      .toConst()
    const { row: tileColumn, column } = rowAndColumn(x, COLUMNS)
    const tile = tileRow.mul(TILE_COLUMNS).add(tileColumn).toConst()
    const { altitude, cosLight } = cell(air, row, column)
    const sinSquaredLight = cosLight.mul(cosLight).oneMinus().toConst()
    const inverseSinLight = sinSquaredLight.inverseSqrt().toConst()
    const rayRow = rowInTarget
      .mul(COLUMNS)
      .add(column)
      .add(0.5)
      .div(BAKE_ROWS * COLUMNS)
      .toConst()

    const sum = vec4(0).toVar()
    loop('ray', at.elevations.mul(at.azimuths).mul(2), ray => {
      const { cosView, towardsLight, cosElevation, solidAngle } = direction(
        air,
        altitude,
        cosLight,
        ray,
        at
      )
      const mu = cosView
      const along = towardsLight.mul(inverseSinLight).toConst()
      const m22 = towardsLight
        .mul(towardsLight)
        .mul(2)
        .sub(cosElevation.mul(cosElevation))
        .div(sinSquaredLight)
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
      const source = vec2(float(ray).add(0.5).div(width), rayRow)
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
export function sumOrders(orders: readonly Table[]): Vec4 {
  return Fn(() => {
    const texel = uv() as Vec2
    // The ratio of the l = 0 moments of the cell, which are positive.
    const tiles = vec2(TILE_COLUMNS, TILE_ROWS)
    const first = texel.sub(texel.mul(tiles).floor().div(tiles)).toConst() as Vec2
    const [before, last] = orders.slice(-2).map(order => order.sample(first)) as [Vec4, Vec4]
    const ratio = last.div(before.max(1e-7)).clamp(0, LARGEST_RATIO).toConst()
    const lights = orders.map(order => order.sample(texel))
    const tail = lights.at(-1)!.mul(ratio.div(ratio.oneMinus()))
    return lights.reduce((sum, light) => sum.add(light) as Vec4).add(tail)
  })()
}
