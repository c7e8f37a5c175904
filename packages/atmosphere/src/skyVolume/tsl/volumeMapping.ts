import { If, mix } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { VOLUME_SIZE } from '../../tables/tableSizes'
import type { Bool, Float } from '../../tsl-types'
import { expandCosine, compressCosine } from '../../diffuseLight/tsl/diffuseLight'
import type { Viewpoint } from '../../view/tsl/viewpoint'
import { sine } from '../../math/tsl/trigonometry'
import type { RayLimits } from './rayLimits'

const [AZIMUTHS] = VOLUME_SIZE

/**
 * Position of an elevation in its half (below or above the horizon), in [0, 1] from the horizon:
 * √tan(α/2), α the angle from it.
 *
 * @param cosView - μ, ray against the zenith of the viewpoint.
 * @param hitsGround - True for the half below the horizon.
 * @param sinView - √(1 − μ²), which from far away is better known than μ tells.
 */
export function elevationPosition(
  viewpoint: Viewpoint,
  cosView: Float,
  hitsGround: Bool,
  sinView: Float
): Float {
  const across = cosView.mul(viewpoint.sinHorizon).sub(sinView.mul(viewpoint.cosHorizon)).abs()
  const along = sinView.mul(viewpoint.sinHorizon).add(cosView.mul(viewpoint.cosHorizon))
  const scale = hitsGround.select(viewpoint.belowScale, viewpoint.aboveScale)
  return across.div(along.add(1).max(1e-6)).mul(scale).clamp().sqrt()
}

/** Texel of a position among so many elevations, the lower half of them below the horizon. */
export function elevationTexel(position: Float, hitsGround: Bool, count: number): Float {
  const half = count / 2
  return position.mul(half - 1).add(hitsGround.select(0.5, half + 0.5))
}

/** Cosine of the zenith angle of an elevation, counted in whole texels. */
export function elevationCosine(
  viewpoint: Viewpoint,
  texel: Float,
  count: number
): { cosView: Float; hitsGround: Bool; position: Float } {
  const half = count / 2
  const hitsGround = texel.lessThan(half).toConst()
  const position = texel
    .floor()
    .sub(hitsGround.select(0, half))
    .div(half - 1)
    .toConst()
  const scale = hitsGround.select(viewpoint.belowScale, viewpoint.aboveScale)
  const tangent = position.mul(position).div(scale).toConst()
  const square = tangent.mul(tangent).toConst()
  const double = tangent.mul(hitsGround.select(-2, 2))
  const cosView = viewpoint.cosHorizon
    .mul(square.oneMinus())
    .add(viewpoint.sinHorizon.mul(double))
    .div(square.add(1))
    .clamp(-1, 1)
  return {
    cosView: cosView.toConst(),
    hitsGround: hitsGround,
    position: position
  }
}

/**
 * The light's cosine μ_s where a ray from outside the air meets the ground or passes nearest to it:
 * the mean over azimuths, and the most that an azimuth adds or takes away.
 *
 * With b = r √(1 − μ²), the ray's distance from the planet's centre, that point is half a chord
 * c = √(r_ground² − b²) before the nearest point, or that point.
 */
function lightAtLowestPoint(
  uniforms: AtmosphereUniforms,
  viewpoint: Viewpoint,
  cosView: Float,
  sinView: Float,
  hitsGround: Bool
) {
  const { bottomRadius } = uniforms
  const nearest = viewpoint.radius.mul(sinView).toConst()
  const square = bottomRadius.sub(nearest).mul(bottomRadius.add(nearest)).max(0)
  const chord = hitsGround.select(square.sqrt(), 0).toConst()
  const across = nearest.mul(cosView).add(chord.mul(sinView))
  const along = nearest.mul(sinView).sub(chord.mul(cosView))
  const inverse = hitsGround.select(bottomRadius, nearest.max(1)).reciprocal().toConst()
  return {
    mean: along.mul(inverse).mul(viewpoint.cosLight).toConst() as Float,
    swing: across.mul(inverse).mul(viewpoint.sinLight).abs().max(1e-4).toConst() as Float
  }
}

/**
 * Column of an azimuth φ from the light, in texels.
 *
 * In the air: sin(φ/2), for the light is smooth in cos φ but changes most towards its source. From outside
 * the azimuth sweeps over day, dusk and night: there columns crowd at dusk.
 *
 * @param cosView - μ.
 * @param cosViewLight - ν.
 */
export function azimuthColumn(
  uniforms: AtmosphereUniforms,
  viewpoint: Viewpoint,
  cosView: Float,
  sinView: Float,
  cosViewLight: Float,
  hitsGround: Bool
): Float {
  const sines = sinView.mul(viewpoint.sinLight).max(1e-6)
  const cosAzimuth = cosViewLight
    .sub(cosView.mul(viewpoint.cosLight))
    .div(sines)
    .clamp(-1, 1)
    .toConst()
  const position = cosAzimuth.oneMinus().mul(0.5).sqrt().toVar()
  If(viewpoint.toTop.lessThan(0), () => {
    const { mean, swing } = lightAtLowestPoint(uniforms, viewpoint, cosView, sinView, hitsGround)
    const first = compressCosine(mean.add(swing)).toConst()
    const last = compressCosine(mean.sub(swing))
    const here = compressCosine(mean.add(swing.mul(cosAzimuth)))
    position.assign(first.sub(here).div(first.sub(last)).clamp())
  })
  return position.mul(AZIMUTHS - 1).add(0.5)
}

/** ν of a column, counted in whole texels: the inverse of {@link azimuthColumn}. */
export function columnCosine(
  uniforms: AtmosphereUniforms,
  viewpoint: Viewpoint,
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
  If(viewpoint.toTop.lessThan(0), () => {
    const { mean, swing } = lightAtLowestPoint(uniforms, viewpoint, cosView, sinView, hitsGround)
    const first = compressCosine(mean.add(swing)).toConst()
    const last = compressCosine(mean.sub(swing))
    const x = mix(first, last, position).toConst()
    cosAzimuth.assign(expandCosine(x).sub(mean).div(swing).clamp(-1, 1))
  })
  const sines = sinView.mul(viewpoint.sinLight)
  return cosView.mul(viewpoint.cosLight).add(sines.mul(cosAzimuth)).clamp(-1, 1).toConst()
}

/** 1/κ and e^κ − 1 of a ray's distances. */
function spacing(viewpoint: Viewpoint, hitsGround: Bool): { stretch: Float; growth: Float } {
  return {
    stretch: hitsGround.select(viewpoint.groundStretch, viewpoint.skyStretch).toConst(),
    growth: hitsGround.select(viewpoint.groundGrowth, viewpoint.skyGrowth).toConst()
  }
}

/** Distance along a ray at a position x in [0, 1] among the slices [m]. */
export function sliceDistance(viewpoint: Viewpoint, limits: RayLimits, position: Float): Float {
  const { stretch, growth } = spacing(viewpoint, limits.hitsGround)
  return position.div(stretch).exp().sub(1).div(growth).mul(limits.length)
}

/** Position among the slices of a distance, the inverse of {@link sliceDistance}. */
export function slicePosition(viewpoint: Viewpoint, limits: RayLimits, distance: Float): Float {
  const { stretch, growth } = spacing(viewpoint, limits.hitsGround)
  const part = distance.div(limits.length.max(1e-3)).clamp()
  return part.mul(growth).add(1).log().mul(stretch).clamp()
}
