import { float } from 'three/tsl'
import type { Node } from 'three/webgpu'
import type { Air } from '../../scattering/tsl/ray'
import { sine } from '../../math/tsl/trigonometry'
import { DIFFUSE_SIZE } from '../../tables/tableSizes'
import type { Float, Int, Vec4Array } from '../../tsl-types'
import { diffuseLightOrigin, diffuseLightSlope } from '../cpu/diffuseLight'
import { expandCosine } from './diffuseLight'

const [COLUMNS, ROWS] = DIFFUSE_SIZE

/** Lowest altitude that rays are sent out from: on the ground itself the horizon has no width [m]. */
const LOWEST_ALTITUDE = 1

/** Greatest cosine of the light's zenith angle, so that moments can be divided by sin θ_s. */
const HIGHEST_LIGHT = 0.9998

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

/** Altitude and light angle of a cell, from its row (a float counted from the ground) and column. */
export function cell(air: Air, row: Float, column: Float) {
  const { thickness } = air.uniforms
  const rowPosition = row.div(ROWS - 1).toConst()
  const altitude = thickness.mul(rowPosition).mul(rowPosition).max(LOWEST_ALTITUDE)
  const x = column
    .div(COLUMNS - 1)
    .div(diffuseLightSlope)
    .add(diffuseLightOrigin)
    .toConst()
  const cosLight = expandCosine(x)
  return {
    altitude: altitude.toConst() as Float,
    cosLight: cosLight.min(HIGHEST_LIGHT).toConst() as Float
  }
}

/** Direction of a ray from a cell, by its number, with the solid angle that it stands for. */
export function direction(air: Air, altitude: Float, cosLight: Float, number: Int, at: Directions) {
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
  const towardsLight = cosElevation.mul(azimuth.cos()).toConst()
  const cosViewLight = towardsLight.mul(sine(cosLight)).add(cosView.mul(cosLight)).clamp(-1, 1)
  return {
    up: up as Node<'bool'>,
    cosView: cosView as Float,
    towardsLight: towardsLight as Float,
    cosElevation: cosElevation as Float,
    cosViewLight: cosViewLight.toConst() as Float,
    solidAngle: solidAngle as Float
  }
}
