// Derives `spectralToXYZ` of AtmosphereParameters: the 3×4 matrix from spectral radiance at four
// wavelengths to CIE XYZ that comes nearest to a solution at 35 wavelengths.
// Run it with: npm run fit-color
import { fileURLToPath } from 'node:url'
import { ciede2000, xyzToLab } from '../../../e2e/validate/color-difference'
import { colorDifferences } from '../../../e2e/validate/figures'
import { readColorReference } from '../../../e2e/validate/reference'
import { rayFromAngles } from '../../../e2e/validate/request'
import { quantile } from '../../../e2e/validate/score'
import { AtmosphereParameters, type SpectralMatrix } from '../src/parameters/AtmosphereParameters'
import type { Triple } from '../src/air/cpu/color'
import { groundRadiance, skyRadiance } from '../src/scattering/cpu/scattering'
import { solveDiffuseLight } from '../src/diffuseLight/cpu/solveDiffuseLight'
import { lightTransmittance } from '../src/transmittance/cpu/transmittance'
import { earthAt, spectrumToXYZ, sunlight, wavelengths } from './spectra'

/** Weight of a sample of sunlight over that of a sky: there are few of them, and they must be right. */
const SUNLIGHT_WEIGHT = 16

const FOUR = new AtmosphereParameters().wavelengths

/** Sample of light: at the four wavelengths, and its true colour. */
interface Sample {
  four: number[]
  xyz: Triple
  /** Y of the white beside it. */
  white: number
  weight: number
}

/** Spectral solutions, four wavelengths each, in ascending order. */
const solutions = wavelengths.flatMap((_, i) => {
  if (i % 4 !== 0) return []
  const p = earthAt(wavelengths.slice(i, i + 4))
  return [{ p, light: solveDiffuseLight(p) }]
})
type Solution = (typeof solutions)[number]

function sample(weight: number, perIrradiance: (solution: Solution) => number[]): Sample {
  const spectrum = solutions.flatMap(perIrradiance).map((value, i) => value * sunlight[i])
  const four = FOUR.map(nm => spectrum[wavelengths.indexOf(nm)])
  const xyz = spectrumToXYZ(spectrum)
  return { four, xyz, white: 4 * xyz[1], weight }
}

/** Evenly spread numbers in [0, 1), the same in every run. @see Roberts 2018, sequence R₄ */
const spread = (i: number, k: number): number =>
  (0.5 + i * [0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101][k]) % 1

/**
 * Skies from the ground to above the air, by day and, half of them, about sunset. They crowd towards
 * the horizon and the sun, where colours are strongest. White is as `spectral_sky.json` has it: four
 * times the mean of skies with the sun as high.
 */
function skies(from: number, count: number): Sample[] {
  const items = Array.from({ length: count }, (_, n) => {
    const [a, b, c, d] = [0, 1, 2, 3].map(k => spread(from + n, k)) as [
      number,
      number,
      number,
      number
    ]
    const heightKm = a < 0.5 ? 0.002 + 2 * a : 1 + 119 * (2 * a - 1) ** 3
    const sunZenith = b < 0.5 ? 168 * b : 84 + 24 * (b - 0.5)
    const fromHorizon = 2 * c - 1
    const viewZenith = 90 - (fromHorizon > 0 ? 90 : 30) * fromHorizon * Math.abs(fromHorizon)
    const ray = rayFromAngles(heightKm, viewZenith, sunZenith, 180 * d * d)
    const item = sample(1, ({ p, light }) =>
      skyRadiance(p, light, { ...ray, radius: p.bottomRadius + ray.altitude })
    )
    return { item, bin: Math.floor(sunZenith / 2) }
  }).filter(({ item }) => item.xyz[1] > 0)
  return items.map(({ item, bin }) => {
    const others = items.filter(other => other.bin === bin).map(other => other.item.xyz[1])
    const white = (4 * others.reduce((sum, y) => sum + y, 0)) / others.length
    return Object.assign(item, { white })
  })
}

const cosDegrees = (degrees: number): number => Math.cos((degrees * Math.PI) / 180)

/** Sunlight that has come down to an altitude [m], the sun at a zenith angle [°]. */
const sun = (zenith: number, altitude: number, weight: number): Sample =>
  sample(weight, ({ p }) => lightTransmittance(p, p.bottomRadius + altitude, cosDegrees(zenith)))

const sunAbove = (weight: number): Sample => sample(weight, () => [1, 1, 1, 1])

/** Ground lit by sun and sky. */
const ground = (zenith: number, weight: number): Sample =>
  sample(weight, ({ p, light }) => groundRadiance(p, light, cosDegrees(zenith)))

function sunlights(weight: number): Sample[] {
  const zeniths = [0, 30, 45, 60, 70, 75, 80, 83, 85, 86.5, 88, 89, 89.6]
  return [
    sunAbove(weight),
    ...zeniths.flatMap(zenith => [0, 3000].map(altitude => sun(zenith, altitude, weight / 2))),
    ...zeniths.map(zenith => ground(zenith, weight / 2))
  ]
}

/** Solves A x = b for a symmetric positive matrix, by Gaussian elimination. */
function solve(matrix: number[][], right: number[]): number[] {
  const rows = matrix.map((row, i) => [...row, right[i]])
  const size = rows.length
  for (let i = 0; i < size; i++) {
    for (let j = i + 1; j < size; j++) {
      const factor = rows[j][i] / rows[i][i]
      for (let k = i; k <= size; k++) rows[j][k] -= factor * rows[i][k]
    }
  }
  const x = Array.from({ length: size }, () => 0)
  for (let i = size - 1; i >= 0; i--) {
    const known = x.reduce((sum, value, k) => (k > i ? sum + value * rows[i][k] : sum), 0)
    x[i] = (rows[i][size] - known) / rows[i][i]
  }
  return x
}

/**
 * Least squares of the errors of X, Y and Z, divided by Y^⅔ W^⅓ with W the Y of white: as CIELAB's L*
 * weighs an error of Y. A weight of its own for each of X, Y and Z would let Z's, tiny in red light,
 * outweigh all else.
 */
function fit(samples: Sample[]): SpectralMatrix {
  return [0, 1, 2].map(k => {
    const normal = [0, 1, 2, 3].map(() => [0, 0, 0, 0])
    const right = [0, 0, 0, 0]
    for (const { four, xyz, white, weight } of samples) {
      const scale = weight / (xyz[1] ** 2 * white) ** (2 / 3)
      for (let i = 0; i < 4; i++) {
        right[i] += scale * four[i] * xyz[k]
        for (let j = 0; j < 4; j++) normal[i][j] += scale * four[i] * four[j]
      }
    }
    return solve(normal, right)
  }) as unknown as SpectralMatrix
}

const apply = (matrix: SpectralMatrix, four: number[]): Triple =>
  matrix.map(row => row.reduce((sum, value, i) => sum + value * four[i], 0)) as Triple

function difference(matrix: SpectralMatrix, { four, xyz, white }: Sample): number {
  return ciede2000(xyzToLab(apply(matrix, four), white), xyzToLab(xyz, white))
}

/** ΔE₀₀ of the chromaticity alone. */
function chromaticityDifference(matrix: SpectralMatrix, { four, xyz, white }: Sample): number {
  const model = apply(matrix, four)
  const same = model.map(value => (value * xyz[1]) / model[1]) as Triple
  return ciede2000(xyzToLab(same, white), xyzToLab(xyz, white))
}

const summary = (values: number[]): string => {
  const mean = values.reduce((sum, value) => sum + value, 0) / values.length
  const [p95, max] = [0.95, 1].map(part => quantile(values, part).toFixed(2))
  return `mean ${mean.toFixed(3)}, p95 ${p95}, max ${max} (n ${values.length})`
}

/** The four-wavelength model against the independent 35-wavelength solution. */
const file = fileURLToPath(new URL('../../../e2e/reference/spectral_sky.json', import.meta.url))
const reference = readColorReference(file)
const onSphere = new AtmosphereParameters({ bottomRadius: 6_360_000, topRadius: 6_420_000 })
const lightOnSphere = solveDiffuseLight(onSphere)
const referenceFours = reference.map(item => {
  const ray = rayFromAngles(
    item.h_km,
    item.view_zenith_deg,
    item.sun_zenith_deg,
    item.rel_azimuth_deg
  )
  const radius = onSphere.bottomRadius + ray.altitude
  return skyRadiance(onSphere, lightOnSphere, { ...ray, radius }).map(
    (value, i) => value * onSphere.solarIrradiance[i]
  )
})

function report(name: string, matrix: SpectralMatrix, unseen: Sample[]): void {
  console.log(`\n${name}`)
  for (const row of matrix) console.log(`  [${row.map(value => value.toFixed(3)).join(', ')}],`)
  const xyz = referenceFours.map(four => apply(matrix, four).map(value => 683 * value) as Triple)
  console.log(`  spectral_sky.json   ${summary(colorDifferences(reference, xyz))}`)
  console.log(`  skies not fitted    ${summary(unseen.map(item => difference(matrix, item)))}`)
  const named: [string, Sample][] = [
    ['sun above the air', sunAbove(1)],
    ...[0, 60, 80, 85, 88].map((zenith): [string, Sample] => [
      `sun at ${zenith}°`,
      sun(zenith, 0, 1)
    ]),
    ...[0, 60, 85].map((zenith): [string, Sample] => [
      `ground, sun at ${zenith}°`,
      ground(zenith, 1)
    ])
  ]
  for (const [label, item] of named) {
    const error = apply(matrix, item.four)[1] / item.xyz[1] - 1
    const color = chromaticityDifference(matrix, item).toFixed(2)
    console.log(
      `  ${label.padEnd(20)}chromaticity ΔE ${color}, luminance ${(100 * error).toFixed(2)} %`
    )
  }
  const lux = 683 * apply(matrix, sunAbove(1).four)[1]
  console.log(`  sun above the air   ${(lux / 1e3).toFixed(1)} klx`)
}

const fitted = skies(0, 900)
const unseen = skies(5000, 400)
console.log(`sun above the air, spectrum: ${(0.683 * sunAbove(1).xyz[1]).toFixed(1)} klx`)
report('In use', new AtmosphereParameters().spectralToXYZ, unseen)
report('Skies alone', fit(fitted), unseen)
report('Sunlight and sunlit ground alone', fit(sunlights(1)), unseen)
report('Skies and sunlight: the result', fit([...fitted, ...sunlights(SUNLIGHT_WEIGHT)]), unseen)
