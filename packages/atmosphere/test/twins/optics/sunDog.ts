import { crystalRows } from '../../../src/optics/cpu/crystalRows'
import { HALF_TEXELS, texelCosine } from '../../../src/optics/cpu/phaseRow'
import { dogAzimuth, leastDogAzimuth } from '../../../scripts/optics/sunDogs'
import { DOG_ELEVATIONS, DOG_SPREAD } from '../../../src/optics/cpu/sunDogs'

const RADIANS = Math.PI / 180
const TEXELS = 2 * HALF_TEXELS

const mix = (a: number, b: number, part: number): number => a + (b - a) * part
const smooth = (from: number, to: number, x: number): number => {
  const t = Math.min(Math.max((x - from) / (to - from), 0), 1)
  return t * t * (3 - 2 * t)
}

/**
 * Green light of crystals at the third wavelength [1/sr], from angles: randomly oriented crystals, and sun dogs beside the sun.
 *
 * @param viewElevation - Elevation of the view ray [°].
 * @param sunElevation - [°].
 * @param azimuth - Angle between both on the horizon [°].
 */
export function crystalPhase(
  regular: number,
  level: number,
  viewElevation: number,
  sunElevation: number,
  azimuth: number
): number {
  const { texels } = crystalRows(regular, level)
  const [e, h] = [viewElevation * RADIANS, sunElevation * RADIANS]
  const cosine = Math.sin(e) * Math.sin(h) + Math.cos(e) * Math.cos(h) * Math.cos(azimuth * RADIANS)
  let texel = 0
  while (texel < TEXELS - 2 && texelCosine(texel + 1) > cosine) texel++
  const place = (i: number): number => Math.sqrt(Math.acos(Math.abs(texelCosine(i))))
  const own = Math.sqrt(Math.acos(Math.min(Math.abs(cosine), 1)))
  const [a, b] = [place(texel), place(texel + 1)]
  const allWays = mix(
    texels[4 * texel + 2],
    texels[4 * texel + 6],
    a === b ? 0 : (own - a) / (b - a)
  )
  const offset = azimuth - leastDogAzimuth(Math.min(Math.max(sunElevation, 0), 60))
  const part = Math.min(dogAzimuth.inverse(offset), 1)
  if (part < 0) return allWays
  const row = (Math.min(Math.max(sunElevation, 0), 60) / 60) * (DOG_ELEVATIONS.length - 1)
  const low = Math.min(Math.floor(row), DOG_ELEVATIONS.length - 2)
  const along = (n: number): number => {
    const at = part * (TEXELS - 1)
    const i = Math.min(Math.floor(at), TEXELS - 2)
    const from = 4 * TEXELS * (n + 1) + 4 * i + 2
    return mix(texels[from], texels[from + 4], at - i)
  }
  const color = Math.max(mix(along(low), along(low + 1), row - low), 0)
  const rise = (viewElevation - sunElevation) / DOG_SPREAD
  const height = Math.exp(-(rise ** 2) / 2) / (DOG_SPREAD * RADIANS * Math.sqrt(2 * Math.PI))
  const linear = part ** 1.5
  const inside = smooth(0, 0.02, linear) * (1 - smooth(0.7, 1, linear))
  return allWays + (color * height * inside) / Math.cos(e)
}
