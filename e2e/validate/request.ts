import type { AtmosphereParametersInit } from '@welkin/atmosphere'
import type { Backend } from '../harness/backend'

/** Way to find light along rays: read from the sky volume, or marched. */
export type Path = 'volume' | 'march'

/** Viewpoint of a sky volume. */
export interface Viewpoint {
  /** Altitude above the ground [m]. */
  altitude: number
  /** μ_s, cosine between sun and zenith. */
  cosLight: number
}

/** A ray from a viewpoint. */
export interface RayRequest extends Viewpoint {
  cosView: number
  cosViewLight: number
  /** Length of a segment; absent for the whole ray [m]. */
  distance?: number
}

/** Values that the page is asked to compute. */
export interface EvaluationRequest {
  backend: Backend
  path: Path
  parameters: AtmosphereParametersInit
  /** Whole rays: radiance of the sky or ground. */
  sky: RayRequest[]
  /** Segments: light scattered in them, and transmittance. */
  segments: RayRequest[]
  /** Cosines of the sun's zenith angle: irradiance on horizontal ground. */
  grounds: number[]
}

/** Four numbers per request, for unit irradiance of the sun above the air. */
export interface EvaluationResult {
  sky: number[]
  inscatter: number[]
  transmittance: number[]
  skyIrradiance: number[]
  sunIrradiance: number[]
}

const cosDegrees = (degrees: number): number => Math.cos((degrees * Math.PI) / 180)
const sinDegrees = (degrees: number): number => Math.sin((degrees * Math.PI) / 180)

/**
 * A ray from the angles of the reference files.
 *
 * @param heightKm - Height of the viewpoint above the ground [km].
 * @param viewZenith - Zenith angle of the ray [°].
 * @param sunZenith - Zenith angle of the sun [°].
 * @param azimuth - Azimuth of the ray from the sun's azimuth [°].
 */
export function rayFromAngles(
  heightKm: number,
  viewZenith: number,
  sunZenith: number,
  azimuth: number
): RayRequest {
  const cosView = cosDegrees(viewZenith)
  const cosLight = cosDegrees(sunZenith)
  const level = sinDegrees(viewZenith) * sinDegrees(sunZenith)
  return {
    altitude: 1000 * heightKm,
    cosLight,
    cosView,
    cosViewLight: cosView * cosLight + level * cosDegrees(azimuth)
  }
}
