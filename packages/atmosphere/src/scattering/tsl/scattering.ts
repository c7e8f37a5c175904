import { float, vec4 } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { miePhase } from '../../air/tsl/phase'
import { groundIrradiance } from '../../diffuseLight/tsl/diffuseLight'
import { RADIANCE_SCALE } from '../../tables/tableSizes'
import { lightTransmittance } from '../../transmittance/tsl/transmittance'
import type { Float, Int, Vec4 } from '../../tsl-types'
import { march } from './march'
import type { Air, Ray } from './ray'
import { scatterSegment, type LightParts, type Scattered } from './segment'

/**
 * Light scattered along a ray, by marching it: the reference for the sky volume, and for rays that
 * start anywhere.
 *
 * @param air - Parameters and tables.
 * @param ray - In the air; it must not cross the ground before `distance`.
 * @param distance - Length of the march [m].
 * @param rise - Altitude at its end less that at its start [m].
 * @param steps - Two evaluations each; 12 are within 0.1 % by day.
 * @param lights - Light to take into account.
 * @returns Light scattered to the ray's origin, and optical depth of the path.
 */
export function scattering(
  air: Air,
  ray: Ray,
  distance: Float,
  rise: Float,
  steps: number | Int,
  lights: LightParts = { direct: true, diffuse: true }
): Scattered & { depth: Vec4 } {
  const molecular = vec4(0).toVar()
  const aerosol = vec4(0).toVar()
  const depth = vec4(0).toVar()
  march(air.uniforms, distance, rise, steps, (start, end) => {
    const segment = scatterSegment(air, ray, start, end, lights)
    const through = depth.negate().exp().toConst()
    molecular.addAssign(segment.molecular.mul(through))
    aerosol.addAssign(segment.aerosol.mul(through))
    depth.addAssign(segment.depth)
  })
  return { molecular, aerosol, depth }
}

/** Adds both parts with the aerosols' phase function, and takes the table's scale out [1/sr]. */
export function scatteredRadiance(
  uniforms: AtmosphereUniforms,
  scattered: Scattered,
  cosViewLight: Float
): Vec4 {
  return scattered.molecular
    .add(scattered.aerosol.mul(miePhase(uniforms, cosViewLight)))
    .mul(1 / RADIANCE_SCALE)
}

/**
 * Radiance of the Lambertian ground, for unit irradiance of the light source [1/sr].
 *
 * @param cosLight - μ_s at the ground.
 * @param lights - Light to take into account.
 */
export function groundRadiance(
  air: Air,
  cosLight: Float,
  lights: LightParts = { direct: true, diffuse: true }
): Vec4 {
  const { uniforms } = air
  let irradiance: Vec4 = vec4(0)
  if (lights.direct) {
    irradiance = lightTransmittance(uniforms, air.transmittance, float(0), cosLight).mul(
      cosLight.max(0)
    )
  }
  if (lights.diffuse && air.diffuse !== null) {
    irradiance = irradiance.add(groundIrradiance(uniforms, air.diffuse, cosLight))
  }
  return irradiance.mul(uniforms.groundAlbedo).mul(1 / Math.PI)
}
