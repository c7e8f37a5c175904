import { If, int, vec3 } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { extinction } from '../../air/tsl/medium'
import { gaussLegendre, weightsTo } from '../../math/cpu/quadrature'
import type { Bool, Float, Vec3, Vec4 } from '../../tsl-types'
import { columnsToSpace, profileAt, type ProfileConstants } from './chapman'
import { marchFromLowest, type AirSegment } from './shellMarch'
import {
  COLUMN_UNIT,
  shellStepExponent,
  sunlitPoint,
  weighted,
  type SingleScatteringSums
} from './singleScatteringSums'

/** Optical depth that hides whatever is behind it. */
const OPAQUE_DEPTH = 7

/** Visible part of a segment: one that passes its nearest point in opaque air ends at its lowest point. */
function visiblePart(
  uniforms: AtmosphereUniforms,
  constants: ProfileConstants,
  segment: AirSegment,
  passesNearest: Bool
): AirSegment {
  const { density } = profileAt(uniforms, constants, segment.lowestAltitude)
  const columns = vec3(constants.horizon.mul(density.xy), 0) as Vec3
  const depth = extinction(uniforms, columns).toConst() as Vec4
  const isOpaque = depth.x.min(depth.y).min(depth.z.min(depth.w)).greaterThan(OPAQUE_DEPTH)
  const length = passesNearest
    .and(isOpaque)
    .select(segment.radiusCosView.negate().clamp(0, segment.length), segment.length)
  return { ...segment, length: length.toConst() }
}

/**
 * Sums singly scattered light for any segment and any sun: a march of a few steps from the lowest point,
 * three quadrature points each.
 */
export function marchSingleScattering(
  uniforms: AtmosphereUniforms,
  constants: ProfileConstants,
  segment: AirSegment,
  sums: SingleScatteringSums
): void {
  const { altitude, radiusCosView, hitsGround } = segment
  const isShort = altitude.lessThan(uniforms.homogeneousHeight.mul(1.25))
  const passesNearest = hitsGround.not().and(radiusCosView.lessThan(0)).toConst() as Bool
  const stepsToSpace = passesNearest.select(4, 3)
  const steps = int(hitsGround.select(isShort.select(1, 3), stepsToSpace)).toConst()
  const visible = visiblePart(uniforms, constants, segment, passesNearest)
  const { nodes, weights } = gaussLegendre(3)
  marchFromLowest(
    uniforms,
    visible,
    steps,
    rise => shellStepExponent(constants, rise),
    (start, end) => {
      const step = end.sub(start).toConst() as Float
      const scaled = step.mul(COLUMN_UNIT).toConst()
      const points = nodes.map(node =>
        sunlitPoint(uniforms, constants, segment, step.mul(node).add(start).toConst() as Float)
      )
      const densities = points.map(({ density }) => density)
      points.forEach((point, i) => {
        const { altitude: height, cosLight, density, visibleDisc } = point
        If(visibleDisc.greaterThan(0), () => {
          const toSun = columnsToSpace(uniforms, constants, height, cosLight, point).mul(
            COLUMN_UNIT
          )
          const before = weighted(densities, weightsTo(nodes, nodes[i])).mul(scaled).max(0)
          const columns = before.add(sums.columns).add(toSun).toConst() as Vec3
          sums.scatter(columns, density.xy.mul(step.mul(visibleDisc).mul(weights[i])).toConst())
        })
      })
      sums.columns.addAssign(weighted(densities, weights).mul(scaled))
    }
  )
}
