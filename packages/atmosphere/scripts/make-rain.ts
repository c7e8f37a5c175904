// Makes src/optics/rainData.ts: phase functions of rain by Mie's theory, as colours of sunlight.
// Run it with: npx tsx packages/atmosphere/scripts/make-rain.ts
import { writeFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { sunlitColor } from './optics/colors'
import { encodePhases } from './optics/encodePhases'
import { gridAngles } from './optics/gridAngles'
import { mieAngles, mieSphere } from './optics/mieSphere'
import { waterIndex } from './optics/refraction'
import { overSunDisc, SUN_RADIUS } from './optics/sunDisc'
import { wavelengths } from './spectra'
import { RAIN_COLOR_STEP, RAIN_RATES, rainGrid } from '../src/optics/cpu/rainRates'

/** Diameters of drops [mm]: even in their logarithm. Smaller ones and larger ones scatter little. */
const COUNT = Number(process.argv[2] ?? 200)
const [LEAST, MOST] = [0.1, 3.5]
const diameters = Array.from(
  { length: COUNT },
  (_, i) => LEAST * (MOST / LEAST) ** ((i + 0.5) / COUNT)
)

/**
 * Drops of each size, times their share of an even step of ln D: N ∝ e^{−ΛD} with Λ = 4.1 R^{−0.21} per mm.
 *
 * @see Marshall & Palmer 1948, "The distribution of raindrops with size", J. Meteor. 5, 165, eqs. 1 and 3
 */
const weights = RAIN_RATES.map(rate =>
  diameters.map(diameter => diameter * Math.exp(-4.1 * rate ** -0.21 * diameter))
)

/** Angles from the point opposite the light, fine where bows are, and from the light [°]. */
const range = (from: number, to: number, step: number): number[] =>
  Array.from({ length: Math.round((to - from) / step) }, (_, i) => from + i * step)
const far = [
  ...range(0, 3, 0.1),
  ...range(3, 34, 0.5),
  ...range(34, 60, 0.08),
  ...range(60, 90.5, 1)
]
const near = [...range(0.4, 3, 0.2), ...range(3, 12, 0.75), ...range(12, 91, 2)]
const toRadians = Math.PI / 180
const angles = mieAngles([
  ...far.map(angle => -Math.cos(angle * toRadians)),
  ...near.map(angle => Math.cos(angle * toRadians))
])
const total = far.length + near.length

const phases = RAIN_RATES.map(() => Array.from({ length: total }, () => [] as number[]))
wavelengths.forEach((nm, w) => {
  const index = waterIndex(nm)
  const scattered = weights.map(() => new Float64Array(total))
  const sections = weights.map(() => 0)
  diameters.forEach((diameter, i) => {
    const size = (Math.PI * diameter * 1000) / (nm / 1000)
    const { efficiency } = mieSphere(size, index, angles)
    weights.forEach((weight, k) => {
      sections[k] += (weight[i] * efficiency * Math.PI * diameter ** 2) / 4
      const share = weight[i] * (diameter / 2 / size) ** 2
      angles.intensity.forEach((value, a) => (scattered[k][a] += share * value))
    })
  })
  phases.forEach((phase, k) =>
    phase.forEach((spectrum, a) => (spectrum[w] = scattered[k][a] / sections[k]))
  )
})

/** Value between samples at rising places. */
function between(places: readonly number[], values: readonly number[], at: number): number {
  let i = 0
  while (i < places.length - 2 && places[i + 1] < at) i++
  const part = Math.min(Math.max((at - places[i]) / (places[i + 1] - places[i]), 0), 1)
  return values[i] + (values[i + 1] - values[i]) * part
}

const rows = phases.map(phase => {
  const colors = phase.map(sunlitColor)
  const [back, front] = [colors.slice(0, far.length), colors.slice(far.length)]
  const row = gridAngles(rainGrid).map(({ angle, isBack }) => {
    const degrees = Math.min(angle / toRadians, 89.7)
    return [0, 1, 2].map(channel => {
      const [places, values] = isBack ? [far, back] : [near, front]
      const channels = values.map(color => color[channel])
      return overSunDisc(at => between(places, channels, at), degrees)
    })
  })
  // Diffraction, half of all, is narrower than the sun's disc: what the rest leaves lies there.
  const disc = Math.PI * (SUN_RADIUS * toRadians) ** 2
  for (let channel = 0; channel < 3; channel++) {
    let rest = 0
    for (const [places, values] of [
      [far, back],
      [near, front]
    ] as const) {
      for (let i = 1; i < places.length && places[i] <= 90; i++) {
        const ring = Math.cos(places[i - 1] * toRadians) - Math.cos(places[i] * toRadians)
        rest += Math.PI * ring * (values[i - 1][channel] + values[i][channel])
      }
    }
    gridAngles(rainGrid).forEach(({ angle, isBack }, i) => {
      if (!isBack && angle < SUN_RADIUS * toRadians) row[i][channel] += (1 - rest) / disc
    })
  }
  return row.map(color => color.map(value => Math.max(value, 1e-5)))
})

const text = encodePhases(rows, RAIN_COLOR_STEP)
const file = fileURLToPath(new URL('../src/optics/rainData.ts', import.meta.url))
writeFileSync(
  file,
  `/** Made by scripts/make-rain.ts; cpu/decodePhases.ts says how to read it. */
export const rainData =
  ${JSON.stringify(text)}
`
)
console.log(`${rows.length} rates, ${(text.length / 1000).toFixed(1)} kB`)
