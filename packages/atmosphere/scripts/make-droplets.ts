// Makes src/optics/dropletData.ts: phase functions of cloud droplets by Mie's theory, as colours of sunlight.
// Run it with: npx tsx packages/atmosphere/scripts/make-droplets.ts
import { writeFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { gridAngles } from './optics/gridAngles'
import { encodePhases } from './optics/encodePhases'
import { sunlitColor } from './optics/colors'
import { mieAngles, mieSphere } from './optics/mieSphere'
import { waterIndex } from './optics/refraction'
import { overSunDisc } from './optics/sunDisc'
import { wavelengths } from './spectra'
import { angleAt, dropletGrid, placeOf } from '../src/optics/cpu/phaseGrid'
import { DROPLET_RADII } from '../src/optics/cpu/dropletRadii'

/** Effective variance of the droplets' sizes, of a gamma distribution (Hansen & Travis 1974, eq. 2.56). */
const VARIANCE = 0.04

/** Radii that are computed [µm]: even in their logarithm. */
const COUNT = 420
const [LEAST, MOST] = [1, 72]
const radii = Array.from({ length: COUNT }, (_, i) => LEAST * (MOST / LEAST) ** (i / (COUNT - 1)))

/** Angles of the fine grid from either end. */
const FINE = 220
const fine = Array.from({ length: FINE }, (_, i) => angleAt(i / (FINE - 1)))
const angles = mieAngles([...fine.map(Math.cos), ...fine.map(angle => -Math.cos(angle))])

/** Droplets of each radius in each distribution, times their share of an even step of ln r. */
const weights = DROPLET_RADII.map(effective =>
  radii.map(r => r ** ((1 - 3 * VARIANCE) / VARIANCE + 1) * Math.exp(-r / (effective * VARIANCE)))
)

/** Phase functions [1/sr]: by distribution, angle and wavelength. */
const phases = DROPLET_RADII.map(() => Array.from({ length: 2 * FINE }, () => [] as number[]))
wavelengths.forEach((nm, w) => {
  const index = waterIndex(nm)
  const scattered = weights.map(() => new Float64Array(2 * FINE))
  const sections = weights.map(() => 0)
  radii.forEach((radius, i) => {
    const number = (2 * Math.PI * radius) / (nm / 1000)
    const { efficiency } = mieSphere(number, index, angles)
    weights.forEach((weight, k) => {
      if (weight[i] < 1e-9 * Math.max(...weight)) return
      sections[k] += weight[i] * efficiency * Math.PI * radius ** 2
      const share = weight[i] * (radius / number) ** 2
      angles.intensity.forEach((value, a) => (scattered[k][a] += share * value))
    })
  })
  phases.forEach((phase, k) =>
    phase.forEach((spectrum, a) => (spectrum[w] = scattered[k][a] / sections[k]))
  )
})

const toDegrees = 180 / Math.PI

const rows = phases.map(phase => {
  const colors = phase.map(sunlitColor)
  /** Colour at an angle from either end [°]. */
  const colorAt = (isBack: boolean, channel: number) => (degrees: number) => {
    const place = placeOf(degrees / toDegrees) * (FINE - 1)
    const i = Math.min(Math.floor(place), FINE - 2)
    const [a, b] = [i, i + 1].map(n => colors[isBack ? FINE + n : n][channel])
    return a + (b - a) * (place - i)
  }
  return gridAngles(dropletGrid).map(({ angle, isBack }) => {
    // Half a disc short of a quarter turn, where both ends meet and nothing is sharp.
    const degrees = Math.min(angle * toDegrees, 89.7)
    return [0, 1, 2].map(channel => overSunDisc(colorAt(isBack, channel), degrees))
  })
})

const text = encodePhases(rows)
const file = fileURLToPath(new URL('../src/optics/dropletData.ts', import.meta.url))
writeFileSync(
  file,
  `/** Made by scripts/make-droplets.ts; cpu/decodePhases.ts says how to read it. */
export const dropletData =
  ${JSON.stringify(text)}
`
)
console.log(`${rows.length} sizes, ${(text.length / 1000).toFixed(1)} kB`)
