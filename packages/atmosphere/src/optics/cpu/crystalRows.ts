import type { Triple } from '../../air/cpu/color'
import { crystalData, sunDogData } from '../crystalData'
import { decodePhases } from './decodePhases'
import { colorSpectrum } from './colorSpectrum'
import { crystalGrid } from './phaseGrid'
import { HALF_TEXELS, phaseRow, texelCosine } from './phaseRow'
import { DOG_ELEVATIONS, DOG_SAMPLES } from './sunDogs'

/** Angle from the light within which rough crystals scatter as others do [rad]: diffraction, and what goes straight on. */
const FORWARD = 0.14

/** Half width of what rough faces blur light by [rad]. */
const BLUR = 0.3

/** Phase function of crystals with rough faces, by the texels of that with flat ones: blurred, without halos. */
function roughRow(texels: Float32Array): Float32Array {
  const angles = Array.from({ length: 2 * HALF_TEXELS }, (_, i) => Math.acos(texelCosine(i)))
  const logarithms = texels.map(value => Math.log(Math.max(value, 1e-6)))
  const first = angles.findIndex(angle => angle >= FORWARD)
  const last = angles.length - 1
  const rough = texels.slice()
  for (let i = first; i <= last; i++) {
    const sums = [0, 0, 0, 0]
    let weights = 0
    for (let n = first; n <= last; n++) {
      const width = angles[Math.min(n + 1, last)] - angles[n - 1]
      const weight = width * Math.exp(-0.5 * ((angles[i] - angles[n]) / BLUR) ** 2)
      for (let k = 0; k < 4; k++) sums[k] += weight * logarithms[4 * n + k]
      weights += weight
    }
    sums.forEach((sum, k) => (rough[4 * i + k] = Math.exp(sum / weights)))
  }
  return rough
}

/** Rows of crystals as shaders read them. */
export interface CrystalRows {
  /** Phase function of all of them but for sun dogs, and a row of sun dogs for each of `DOG_ELEVATIONS`: four numbers a texel. */
  readonly texels: Float32Array
  /** Asymmetry g. */
  readonly asymmetry: number
}

/**
 * Rows of crystals of which a share has flat faces.
 *
 * @param regular - Share of crystals with flat faces, in [0, 1].
 * @param level - Share of the plates that float level, in [0, 1]; plates are half of all.
 */
export function crystalRows(regular: number, level: number): CrystalRows {
  const { forward, backward } = crystalGrid
  const flat = phaseRow(decodePhases(crystalData, forward + backward), crystalGrid)
  const rough = roughRow(flat.texels)
  const dogs = decodePhases(sunDogData, DOG_SAMPLES)
  const row = 8 * HALF_TEXELS
  const texels = new Float32Array(row * (1 + DOG_ELEVATIONS.length))
  flat.texels.forEach((value, i) => (texels[i] = rough[i] + regular * (value - rough[i])))
  for (let dog = 0; dog < DOG_ELEVATIONS.length; dog++) {
    for (let texel = 0; texel < 2 * HALF_TEXELS; texel++) {
      const place = (texel / (2 * HALF_TEXELS - 1)) * (DOG_SAMPLES - 1)
      const from = Math.min(Math.floor(place), DOG_SAMPLES - 2)
      const color = [0, 1, 2].map(channel => {
        const [a, b] = [from, from + 1].map(n => dogs[3 * (dog * DOG_SAMPLES + n) + channel])
        return (a + (b - a) * (place - from)) * regular * level * 0.5
      }) as Triple
      texels.set(colorSpectrum(color), row * (dog + 1) + 4 * texel)
    }
  }
  return { texels, asymmetry: flat.moments[0] }
}
