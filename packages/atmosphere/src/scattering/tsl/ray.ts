import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { altitudeAlong } from '../../air/tsl/boundary'
import type { Table } from '../../tables/TableAtlas'
import type { Float } from '../../tsl-types'

/** Everything that says how the air scatters: its parameters and the two tables. */
export interface Air {
  /** Parameters of the air. */
  uniforms: AtmosphereUniforms
  /** Optical depth to the top of the air. */
  transmittance: Table
  /** Diffuse-light table; without it there is no light but the sun's. */
  diffuse: Table | null
}

/** A ray in the mapped, spherical space: four numbers are all that matters by symmetry. */
export interface Ray {
  /** Origin above the ground, in [0, thickness] [m]. */
  altitude: Float
  /** μ, ray against zenith, at the origin. */
  cosView: Float
  /** μ_s, light against zenith, at the origin. */
  cosLight: Float
  /** ν, ray against the light. */
  cosViewLight: Float
}

/** Cosines and altitude at a distance along a ray. */
export function pointAlong({ uniforms }: Air, ray: Ray, distance: Float) {
  const { bottomRadius } = uniforms
  const radius = bottomRadius.add(ray.altitude)
  const altitude = altitudeAlong(ray.altitude, ray.cosView, distance, bottomRadius).max(0).toConst()
  const inverse = bottomRadius.add(altitude).reciprocal().toConst()
  return {
    altitude: altitude as Float,
    cosView: radius.mul(ray.cosView).add(distance).mul(inverse).clamp(-1, 1).toConst() as Float,
    cosLight: radius
      .mul(ray.cosLight)
      .add(distance.mul(ray.cosViewLight))
      .mul(inverse)
      .clamp(-1, 1)
      .toConst() as Float
  }
}
