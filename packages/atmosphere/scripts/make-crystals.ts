// Makes src/optics/crystalData.ts: phase functions of ice crystals by ray tracing, as colours of sunlight.
// Run it with: npx tsx packages/atmosphere/scripts/make-crystals.ts
import { writeFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { sunlitColor } from './optics/colors'
import { haloBeams, spreadBeams } from './optics/beamDiffraction'
import {
  meanShadow,
  randomAxes,
  shadowArea,
  toCrystal,
  traceRay,
  type Axes,
  type Prism
} from './optics/crystal'
import { discDiffraction } from './optics/discDiffraction'
import { encodePhases } from './optics/encodePhases'
import { iceIndex } from './optics/refraction'
import { overSunDisc, SUN_RADIUS } from './optics/sunDisc'
import { wavelengths } from './spectra'
import { gridAngles } from './optics/gridAngles'
import { dogAzimuth, leastDogAzimuth, PLATE_TILT } from './optics/sunDogs'
import { crystalGrid, placeOf } from '../src/optics/cpu/phaseGrid'
import { DOG_ELEVATIONS, DOG_SAMPLES } from '../src/optics/cpu/sunDogs'

/** Rays of each wavelength, and of each for a sun dog. */
const RAYS = Number(process.argv[2] ?? 100_000)

/** Columns twice as long as wide: half of the crystals. */
const column: Prism = { halfLength: 2 }

/** Plates, 2.5 to 20 times as wide as thick: the other half. @param place - In [0, 1], each as often. */
const plateAt = (place: number): Prism => ({ halfLength: 0.05 * 8 ** place })

/** Numbers in [0, 1), the same in every run: a linear congruential generator, its bits stirred. */
let state = 1
const random = (): number => {
  state = (state * 1664525 + 1013904223) % 4294967296
  const mixed = Math.imul(state ^ (state >>> 15), 0x2c1b3c6d) >>> 0
  return ((mixed ^ (mixed >>> 12)) >>> 0) / 4294967296
}

const toDegrees = 180 / Math.PI
const clamp = (x: number): number => Math.max(-1, Math.min(1, x))

/** Bins of the scattering angle, even in `placeOf`, for the light side and the far side. */
const BINS = 900

/** Ray-traced phase function by wavelength and bin, and its part that goes straight on. */
const bins = wavelengths.map(() => [new Float64Array(BINS), new Float64Array(BINS)])
const straight = wavelengths.map(() => 0)
wavelengths.forEach((nm, w) => {
  const index = iceIndex(nm)
  let whole = 0
  for (let i = 0; i < RAYS; i++) {
    const prism = i % 2 === 0 ? column : plateAt(random())
    const direction = toCrystal(randomAxes(random), [0, 0, 1])
    const weight = shadowArea(prism, direction) / meanShadow(prism)
    const out = traceRay(prism, index, direction, random)
    const cosine = clamp(out[0] * direction[0] + out[1] * direction[1] + out[2] * direction[2])
    whole += weight
    if (cosine > 1 - 1e-9) straight[w] += weight
    else {
      const angle = Math.acos(Math.abs(cosine))
      const bin = Math.min(Math.floor(placeOf(angle) * BINS), BINS - 1)
      bins[w][cosine < 0 ? 1 : 0][bin] += weight
    }
  }
  straight[w] /= whole
  for (const side of bins[w]) {
    for (let bin = 0; bin < BINS; bin++) {
      const [a, b] = [bin, bin + 1].map(n => Math.cos((Math.PI / 2) * (n / BINS) ** 2))
      side[bin] /= whole * 2 * Math.PI * (a - b)
    }
  }
})

/** Light of a wavelength that rays have, over the sun's disc [1/sr]. */
function tracedAt(w: number, degrees: number, isBack: boolean): number {
  const traced = (angle: number): number => {
    const place = placeOf(angle / toDegrees) * BINS - 0.5
    const from = Math.max(Math.min(Math.floor(place), BINS - 2), 0)
    const side = bins[w][isBack ? 1 : 0]
    return side[from] + (side[from + 1] - side[from]) * Math.max(place - from, 0)
  }
  // As far from halos as light is smooth, chance is evened out over more.
  const sharp = degrees > 20.7 && degrees < 56
  const reach = isBack ? 1.5 + 0.1 * degrees : sharp ? 0 : 0.03 + 0.12 * degrees
  let sum = 0
  const steps = reach > 0 ? 9 : 1
  for (let i = 0; i < steps; i++) {
    let at = degrees + reach * ((2 * i + 1) / steps - 1)
    if (!isBack && degrees < 21) at = Math.min(at, 20.7)
    sum += overSunDisc(traced, Math.min(Math.abs(at), 89.7)) / steps
  }
  return sum
}

/** Angles of light that beams spread, from the light to a quarter turn, and the angle from which on they do [°]: before it all is smooth. */
const FINE = 1801
const SPREAD_FROM = 12

/** Columns, and as many plates: halves of the crystals. */
const PLATES = 4
const plates = Array.from({ length: PLATES }, (_, i) => plateAt((i + 0.5) / PLATES))
const beams = haloBeams([...plates.map(() => column), ...plates])

/** Light of each wavelength with halos, as wide as beams make them. */
const haloes = wavelengths.map((nm, w) => {
  const fine = Array.from({ length: FINE }, (_, i) => tracedAt(w, (90 * i) / (FINE - 1), false))
  return spreadBeams(fine, SPREAD_FROM, beams, nm / 1000)
})

/** Mean over the sun's disc of a wavelength's light, with diffraction and what goes straight on [1/sr]. */
const diffraction = wavelengths.map(nm => discDiffraction(nm / 1000))
function phaseAt(w: number, degrees: number, isBack: boolean): number {
  if (isBack) return tracedAt(w, degrees, true) / 2
  const place = (degrees / 90) * (FINE - 1)
  const from = Math.min(Math.floor(place), FINE - 2)
  const [a, b] = haloes[w].slice(from, from + 2)
  const disc = degrees < SUN_RADIUS ? 1 / (Math.PI * (SUN_RADIUS / toDegrees) ** 2) : 0
  const diffracted = overSunDisc(diffraction[w], Math.min(degrees, 89.7))
  return (a + (b - a) * (place - from) + straight[w] * disc + diffracted) / 2
}

const rows = [
  gridAngles(crystalGrid).map(({ angle, isBack }) =>
    sunlitColor(wavelengths.map((_, w) => phaseAt(w, angle * toDegrees, isBack)))
  )
]

/** Elevations of light in sun dogs, from the sun's [°]. */
const rises: number[] = []

/** Level plates: light about the sun's own elevation, per azimuth, over their mean shadow [1/rad]. */
const dogs = DOG_ELEVATIONS.map(elevation => {
  const h = elevation / toDegrees
  const light: [number, number, number] = [-Math.cos(h), 0, -Math.sin(h)]
  const spectra = Array.from({ length: DOG_SAMPLES }, () => wavelengths.map(() => 0))
  wavelengths.forEach((nm, w) => {
    const index = iceIndex(nm)
    for (let i = 0; i < RAYS; i++) {
      const { out, weight } = tiltedRay(index, light)
      const azimuth = Math.abs(Math.atan2(-out[1], -out[0])) * toDegrees
      const rise = Math.asin(clamp(-out[2])) * toDegrees - elevation
      const offset = azimuth - leastDogAzimuth(elevation)
      const bin = Math.round(dogAzimuth.inverse(offset) * (DOG_SAMPLES - 1))
      if (Math.abs(rise) > 4 * PLATE_TILT || bin < 0 || bin >= DOG_SAMPLES) continue
      const part = bin / (DOG_SAMPLES - 1)
      const half = 0.5 / (DOG_SAMPLES - 1)
      const [from, to] = [Math.max(part - half, 0), Math.min(part + half, 1)].map(dogAzimuth.at)
      // Both sides of the sun.
      if (elevation === 20 && Math.abs(offset) < 3) rises.push(rise)
      spectra[bin][w] += weight / (((to - from) / toDegrees) * 2 * RAYS)
    }
  })
  // Half of what is scattered is diffracted.
  return spectra.map(spectrum => sunlitColor(spectrum.map(value => value / 2)))
})

/** Ray that leaves a plate which floats nearly level, and the plate's shadow over the mean of plates all ways. */
function tiltedRay(
  index: number,
  light: readonly [number, number, number]
): { out: number[]; weight: number } {
  const tilt = (PLATE_TILT / toDegrees) * Math.sqrt(-2 * Math.log(1 - random()))
  const [around, turn] = [2 * Math.PI * random(), 2 * Math.PI * random()]
  // The axis leans by the tilt, and the plate is turned about it.
  const [s, c] = [Math.sin(tilt), Math.cos(tilt)]
  const z: [number, number, number] = [s * Math.cos(around), s * Math.sin(around), c]
  const u: [number, number, number] = [c * Math.cos(around), c * Math.sin(around), -s]
  const v: [number, number, number] = [-Math.sin(around), Math.cos(around), 0]
  const turned = (a: number, b: number) => (i: number) => u[i] * a + v[i] * b
  const x = [0, 1, 2].map(turned(Math.cos(turn), Math.sin(turn))) as Axes[0]
  const y = [0, 1, 2].map(turned(-Math.sin(turn), Math.cos(turn))) as Axes[1]
  // A point of the sun's disc.
  const spread = (SUN_RADIUS / toDegrees) * Math.sqrt(random())
  const spoke = 2 * Math.PI * random()
  const [aside, up] = [spread * Math.cos(spoke), spread * Math.sin(spoke)]
  const from: [number, number, number] = [
    light[0] - up * light[2],
    light[1] + aside,
    light[2] + up * light[0]
  ]
  const length = Math.hypot(...from)
  const direction = toCrystal([x, y, z], from.map(value => value / length) as Axes[0])
  const plate = plateAt(random())
  const weight = shadowArea(plate, direction) / meanShadow(plate)
  const [a, b, c3] = traceRay(plate, index, direction, random)
  return { out: [0, 1, 2].map(i => a * x[i] + b * y[i] + c3 * z[i]), weight }
}

const risen = Math.sqrt(rises.reduce((sum, rise) => sum + rise ** 2, 0) / rises.length)
console.log(`sun dogs are ${risen.toFixed(2)}° high, standard deviation`)
const halo = encodePhases(rows)
const floor = 1e-4
const dogText = encodePhases(dogs.map(row => row.map(color => color.map(v => Math.max(v, floor)))))
const file = fileURLToPath(new URL('../src/optics/crystalData.ts', import.meta.url))
writeFileSync(
  file,
  `/** Made by scripts/make-crystals.ts; cpu/decodePhases.ts says how to read them: randomly oriented crystals, and level plates by elevation of the sun. */
export const crystalData =
  ${JSON.stringify(halo)}
export const sunDogData =
  ${JSON.stringify(dogText)}
`
)
console.log(
  `halo ${(halo.length / 1000).toFixed(1)} kB, sun dogs ${(dogText.length / 1000).toFixed(1)} kB`
)
