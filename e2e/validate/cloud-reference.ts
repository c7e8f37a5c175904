import type { CloudPhaseParameters } from '@welkin/clouds'
import type { Reader } from './reference'
import { readJson, type Json } from './reference'

/** A radiance that a cloud sends out, per unit irradiance of the sun [1/sr]. */
export interface CloudCase {
  shape: 'slab' | 'sphere'
  /** Name of its phase function. */
  phase: string
  /** Optical thickness, or diameter. */
  tau: number
  /** Angle of the sun from the slab's normal; for spheres between the rays to camera and sun [°]. */
  sunAngle: number
  /** Name: all else that tells it from the others. */
  label: string
  /** Angle of the exit from the slab's normal [°]; 0 for spheres. */
  exitZenith: number
  /** Input of the shader: see page/clouds.ts. */
  input: [number, number, number, number]
  reference: number
  /** Standard error of the reference; 0 where it is not a Monte-Carlo figure. */
  stderr: number
}

/** A file like `reference/cloud_slab.json`. */
export interface CloudReference {
  phases: Record<string, CloudPhaseParameters>
  cases: CloudCase[]
}

const cosDegrees = (degrees: number): number => Math.cos((degrees * Math.PI) / 180)

/** A phase function from its name: `hg085`, `dual_0.8xHG0.8+0.2xHG-0.2`, `isotropic`. */
function readPhase(reader: Reader, value: unknown, albedo: number): CloudPhaseParameters {
  const name = String(value)
  const single = /^hg0(\d+)$/.exec(name)
  const dual = /^dual_([\d.]+)xHG(-?[\d.]+)\+[\d.]+xHG(-?[\d.]+)$/.exec(name)
  const lobes =
    name === 'isotropic'
      ? [1, 0, 0]
      : single !== null
        ? [1, Number(`0.${single[1]}`), 0]
        : (dual?.slice(1).map(Number) ?? reader.fail(`names no known phase function: ${name}`))
  const [forwardShare, forwardAsymmetry, backwardAsymmetry] = lobes
  return { forwardShare, forwardAsymmetry, backwardAsymmetry, scatteringAlbedo: albedo }
}

function readSlab(place: Reader, item: Json): CloudCase[] {
  const number = (key: string): number => place.at(key).number(item[key])
  const tau = number('tau')
  const sunAngle = number('sun_zenith_deg')
  return place
    .at('radiance')
    .list(item.radiance)
    .map((value, i) => {
      const at = place.at('radiance').at(i)
      const ray = at.object(value)
      const [exitZenith, azimuth, cosScatter, reference] = (
        ['exit_zenith_deg', 'azimuth_deg', 'cos_scatter', 'L'] as const
      ).map(key => at.at(key).number(ray[key]))
      const isReflected = ray.side === 'reflected'
      if (!isReflected && ray.side !== 'transmitted') at.fail('must be reflected or transmitted')
      const cosView = cosDegrees(exitZenith) * (isReflected ? -1 : 1)
      return {
        shape: 'slab',
        phase: String(item.phase),
        tau,
        sunAngle,
        label: `${ray.side} ${exitZenith}°, azimuth ${azimuth}°`,
        exitZenith,
        input: [tau, cosDegrees(sunAngle), cosView, cosScatter],
        reference,
        stderr: 0
      }
    })
}

function readSphere(place: Reader, item: Json): CloudCase {
  const number = (key: string): number => place.at(key).number(item[key])
  const tau = number('tau_diameter')
  const sunAngle = number('view_sun_angle_deg')
  const [sunward, side] = [number('offset_sunward'), number('offset_side')]
  return {
    shape: 'sphere',
    phase: String(item.phase),
    tau,
    sunAngle,
    label: `offset ${sunward}, ${side}`,
    exitZenith: 0,
    input: [tau, cosDegrees(sunAngle), sunward, side],
    reference: number('L'),
    stderr: number('stderr')
  }
}

/**
 * Reads a file of radiances out of slabs and spheres of cloud.
 *
 * @throws If it cannot be read, or is not of this schema; the message says where.
 */
export function readCloudReference(file: string): CloudReference {
  const { reader, content } = readJson(file)
  const meta = reader.at('meta').object(content.meta)
  const albedo = reader
    .at('meta')
    .at('single_scattering_albedo')
    .number(meta.single_scattering_albedo)
  const phases: Record<string, CloudPhaseParameters> = {}
  const section = <T>(key: string, read: (place: Reader, item: Json) => T): T[] =>
    reader
      .at(key)
      .list(content[key])
      .map((value, i) => {
        const place = reader.at(key).at(i)
        const item = place.object(value)
        phases[String(item.phase)] ??= readPhase(place.at('phase'), item.phase, albedo)
        return read(place, item)
      })
  return { cases: [...section('slab', readSlab).flat(), ...section('sphere', readSphere)], phases }
}
