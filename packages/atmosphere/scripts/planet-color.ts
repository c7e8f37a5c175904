// How well four wavelengths and the Earth's `spectralToXYZ` stand for 35 wavelengths on other planets
// and in the standard atmosphere.
// Run it with: npx tsx packages/atmosphere/scripts/planet-color.ts
import { ciede2000, xyzToLab } from '../../../e2e/validate/color-difference'
import { rayFromAngles } from '../../../e2e/validate/request'
import { quantile } from '../../../e2e/validate/score'
import {
  AtmosphereParameters,
  spectrumOf,
  type Spectrum
} from '../src/parameters/AtmosphereParameters'
import type { Triple } from '../src/air/cpu/color'
import { skyRadiance } from '../src/scattering/cpu/scattering'
import { solveDiffuseLight } from '../src/diffuseLight/cpu/solveDiffuseLight'
import { marsParameters, titanParameters, venusParameters } from '../src/parameters/planets'
import { standardEarthParameters } from '../src/parameters/standardEarth'
import { spectrumToXYZ, standardAt, sunlight, wavelengths } from './spectra'

/** A value at any wavelength from those at four: straight lines, carried on beyond the ends. */
function between(from: Spectrum, values: Spectrum, nm: number): number {
  const i = Math.min(Math.max(from.findIndex(x => x >= nm) - 1, 0), 2)
  const last = nm > from[3] ? 2 : i
  const part = (nm - from[last]) / (from[last + 1] - from[last])
  return values[last] + part * (values[last + 1] - values[last])
}

/** The same planet at four other wavelengths. */
function at(planet: AtmosphereParameters, nm: readonly number[]): AtmosphereParameters {
  const spread = (values: number | Spectrum, min = 0, max = Infinity): Spectrum =>
    nm.map(x =>
      Math.min(Math.max(between(planet.wavelengths, spectrumOf(values), x), min), max)
    ) as unknown as Spectrum
  const extinction = spread(planet.mieExtinction)
  const albedo = spread(
    planet.mieScattering.map((value, i) => value / planet.mieExtinction[i]) as unknown as Spectrum,
    0,
    1
  )
  return new AtmosphereParameters({
    bottomRadius: planet.bottomRadius,
    topRadius: planet.topRadius,
    sunAngularRadius: planet.sunAngularRadius,
    rayleighScaleHeight: planet.rayleighScaleHeight,
    mieScaleHeight: planet.mieScaleHeight,
    wavelengths: nm as unknown as Spectrum,
    rayleighScattering: nm.map(
      x => planet.rayleighScattering[1] * (planet.wavelengths[1] / x) ** 4
    ) as unknown as Spectrum,
    mieExtinction: extinction,
    mieScattering: extinction.map((value, i) => value * albedo[i]) as unknown as Spectrum,
    mieAsymmetry: spread(planet.mieAsymmetry, -0.95, 0.95),
    groundAlbedo: spread(planet.groundAlbedo, 0, 1),
    absorptionExtinction: [0, 0, 0, 0]
  })
}

const quality = {
  sun: { elevations: 8, azimuths: 8, steps: 6 },
  diffuse: { elevations: 6, azimuths: 5, steps: 4 }
}

const DAY = [20, 60, 80, 86]

for (const { name, planet, suns = DAY, atWavelengths = at } of [
  { name: 'Mars', planet: marsParameters() },
  { name: 'Titan', planet: titanParameters() },
  { name: 'Venus', planet: venusParameters() },
  {
    name: 'Standard',
    planet: standardEarthParameters(),
    suns: [...DAY, 90, 93, 96],
    atWavelengths: (_: AtmosphereParameters, nm: readonly number[]) => standardAt(nm)
  }
]) {
  const scale = planet.solarIrradiance[1] / new AtmosphereParameters().solarIrradiance[1]
  const parts = wavelengths.flatMap((_, i) => {
    if (i % 4 !== 0) return []
    const p = atWavelengths(planet, wavelengths.slice(i, i + 4))
    return [{ p, light: solveDiffuseLight(p, quality) }]
  })
  const light = solveDiffuseLight(planet, quality)
  const differences: number[] = []
  for (const sun of suns) {
    const skies = [5, 40, 70, 85, 100, 150].flatMap(view =>
      [0, 30, 90, 180].map(azimuth => {
        const ray = rayFromAngles(0.002, view, sun, azimuth)
        const sky = (p: AtmosphereParameters, table: typeof light): number[] =>
          skyRadiance(p, table, { ...ray, radius: p.bottomRadius + ray.altitude })
        const spectrum = parts.flatMap(part => sky(part.p, part.light))
        const four = sky(planet, light).map((value, i) => value * planet.solarIrradiance[i])
        const model = planet.spectralToXYZ.map(row =>
          row.reduce((sum, value, i) => sum + value * four[i], 0)
        ) as Triple
        const true35 = spectrumToXYZ(spectrum.map((value, i) => value * sunlight[i] * scale))
        return { model, true35 }
      })
    )
    const white = (4 * skies.reduce((sum, { true35 }) => sum + true35[1], 0)) / skies.length
    for (const { model, true35 } of skies) {
      differences.push(ciede2000(xyzToLab(model, white), xyzToLab(true35, white)))
    }
  }
  const mean = differences.reduce((sum, value) => sum + value, 0) / differences.length
  const [p95, most] = [0.95, 1].map(part => quantile(differences, part).toFixed(2))
  console.log(`${name}: ΔE2000 mean ${mean.toFixed(2)}, p95 ${p95}, max ${most}`)
}
