import { AtmosphereParameters, type AtmosphereParametersInit } from '@welkin/atmosphere'
import { ciede2000, xyzToLab, type Triple } from './color-difference'
import type { ColorSample, SkyReference } from './reference'
import {
  rayFromAngles,
  type EvaluationRequest,
  type EvaluationResult,
  type RayRequest
} from './request'
import { compare, quantile, type Comparison } from './score'

type Where = Pick<EvaluationRequest, 'backend' | 'path'>

interface Angles {
  h_km: number
  view_zenith_deg: number
  sun_zenith_deg: number
  rel_azimuth_deg: number
}

const rayOf = (sample: Angles): RayRequest =>
  rayFromAngles(sample.h_km, sample.view_zenith_deg, sample.sun_zenith_deg, sample.rel_azimuth_deg)

const labelOf = (sample: Angles): string =>
  `${sample.h_km} km, view ${sample.view_zenith_deg}°, sun ${sample.sun_zenith_deg}°, ` +
  `azimuth ${sample.rel_azimuth_deg}°`

/** Request for the values of a file of spectral radiances. */
export function skyRequest(reference: SkyReference, where: Where): EvaluationRequest {
  const { parameters, sky = [], segments = [], irradiance = [] } = reference
  return {
    ...where,
    parameters,
    sky: sky.map(rayOf),
    segments: segments.map(sample =>
      Object.assign(rayOf(sample), { distance: 1e3 * sample.distance_km })
    ),
    grounds: irradiance.map(sample => Math.cos((sample.sun_zenith_deg * Math.PI) / 180))
  }
}

/** Relative errors, per quantity that the file has. */
export interface SkyComparisons {
  sky?: Comparison[]
  inscatter?: Comparison[]
  transmittance?: Comparison[]
  irradiance?: Comparison[]
}

/** Holds what the page computed against the file. */
export function compareSky(reference: SkyReference, result: EvaluationResult): SkyComparisons {
  const { sky, segments, irradiance, solarIrradiance } = reference
  const four = (values: number[], i: number): number[] => values.slice(4 * i, 4 * i + 4)
  const unit = solarIrradiance.map(() => 1)
  const segmentLabel = (sample: Angles & { distance_km: number }): string =>
    `${sample.distance_km} km from ${labelOf(sample)}`
  const comparisons: SkyComparisons = {
    sky: sky?.flatMap((sample, i) =>
      compare(
        sample.sun_zenith_deg,
        four(result.sky, i),
        sample.L_total,
        sample.L_total_stderr,
        solarIrradiance,
        labelOf(sample)
      )
    ),
    inscatter: segments?.flatMap((sample, i) =>
      compare(
        sample.sun_zenith_deg,
        four(result.inscatter, i),
        sample.inscatter,
        sample.inscatter_stderr,
        solarIrradiance,
        segmentLabel(sample)
      )
    ),
    transmittance: segments?.flatMap((sample, i) =>
      compare(
        sample.sun_zenith_deg,
        four(result.transmittance, i),
        sample.transmittance,
        null,
        unit,
        segmentLabel(sample)
      )
    ),
    irradiance: irradiance?.flatMap((sample, i) => {
      const sun = sample.sun_zenith_deg
      const bySky = four(result.skyIrradiance, i)
      const bySun = four(result.sunIrradiance, i)
      const both = bySky.map((value, k) => value + bySun[k])
      const reference = sample.sky.map((value, k) => value + sample.direct[k])
      const isNight = sample.direct.every(value => value === 0)
      const against = (model: number[], values: number[], what: string): Comparison[] =>
        compare(sun, model, values, sample.sky_stderr, solarIrradiance, `${what}, sun ${sun}°`)
      const skyAlone = against(bySky, sample.sky, 'by the sky')
      return isNight ? skyAlone : skyAlone.concat(against(both, reference, 'by sky and sun'))
    })
  }
  return Object.fromEntries(Object.entries(comparisons).filter(([, list]) => list !== undefined))
}

/**
 * Irradiance of the ground by the sun alone, beside the figures that have goals. The model lights the
 * ground with the disc's mean transmittance from the direction of its middle; the reference takes the
 * cosine at every point of the disc, which differs at sunset.
 */
export function compareSun(reference: SkyReference, result: EvaluationResult): Comparison[] {
  return (reference.irradiance ?? []).flatMap((sample, i) =>
    compare(
      sample.sun_zenith_deg,
      result.sunIrradiance.slice(4 * i, 4 * i + 4),
      sample.direct,
      null,
      reference.solarIrradiance,
      `sun ${sample.sun_zenith_deg}°`
    )
  )
}

/** The Earth's air on the sphere of radius 6360 km that the file of colours was made for. */
function colorParameters(): AtmosphereParameters {
  return new AtmosphereParameters({ bottomRadius: 6_360_000, topRadius: 6_420_000 })
}

/** Request for the values of a file of sky colours. */
export function colorRequest(samples: ColorSample[], where: Where): EvaluationRequest {
  return {
    ...where,
    parameters: Object.assign<AtmosphereParametersInit, unknown>({}, colorParameters()),
    sky: samples.map(rayOf),
    segments: [],
    grounds: []
  }
}

/** Statistics of ΔE₀₀. */
export interface ColorFigures {
  n: number
  mean: number
  p95: number
  max: number
}

/**
 * ΔE₀₀ per sample. White is four times the mean Y of the samples within the same two degrees of the
 * sun's zenith angle.
 *
 * @param xyz - Colours that the model gave [cd/m²].
 */
export function colorDifferences(samples: ColorSample[], xyz: Triple[]): number[] {
  const bin = (sample: ColorSample): number => Math.floor(sample.sun_zenith_deg / 2)
  const luminances = new Map<number, number[]>()
  for (const sample of samples) {
    luminances.set(bin(sample), [...(luminances.get(bin(sample)) ?? []), sample.XYZ[1]])
  }
  return samples.map((sample, i) => {
    const bright = luminances.get(bin(sample))!
    const whiteY = (4 * bright.reduce((sum, y) => sum + y, 0)) / bright.length
    return ciede2000(xyzToLab(xyz[i], whiteY), xyzToLab(sample.XYZ, whiteY))
  })
}

/** Holds what the page computed against the file of colours. */
export function compareColors(samples: ColorSample[], result: EvaluationResult): ColorFigures {
  const { spectralToXYZ, solarIrradiance } = colorParameters()
  const xyz = samples.map(
    (_, i) =>
      spectralToXYZ.map(row =>
        row.reduce(
          (sum, weight, k) => sum + 683 * weight * solarIrradiance[k] * result.sky[4 * i + k],
          0
        )
      ) as Triple
  )
  const differences = colorDifferences(samples, xyz)
  return {
    n: differences.length,
    mean: differences.reduce((sum, value) => sum + value, 0) / differences.length,
    p95: quantile(differences, 0.95),
    max: Math.max(...differences)
  }
}
