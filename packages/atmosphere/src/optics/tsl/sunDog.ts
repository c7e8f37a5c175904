import { acos, asin, smoothstep, vec2 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { HALF_TEXELS } from '../cpu/phaseRow'
import { DOG_ELEVATIONS, DOG_RANGE, DOG_START, DOG_SPREAD, RED_ICE } from '../cpu/sunDogs'
import type { ScatteringAngles } from '../ScatteringPhase'
import { sampleLevel0, type Float, type Vec4 } from '../../tsl-types'

const DEGREES = Math.PI / 180

/** Cosine of the greatest elevation at which the sun has dogs. */
const LEAST_COSINE = Math.cos(60 * DEGREES)

/**
 * Sun dogs [1/sr]: light that level plates scatter aside, at the elevation of their light. Twin: test/twins/optics/sunDog.ts
 *
 * They begin at the least deviation Δ in a prism of 60° that stands upright: sin(½(Δ + 60°)) = ½ n′ with Bravais's index
 * n′ = √(n² − sin² h)/cos h for light of elevation h.
 *
 * @param table - Rows of `crystalRows`.
 */
export function sunDog(
  table: TextureNode,
  { cosViewLight, cosView, cosLight }: ScatteringAngles
): Vec4 {
  const sine = cosLight.clamp(0, Math.sin(60 * DEGREES)).toConst() as Float
  const square = sine.mul(sine).toConst()
  const cosine = square.oneMinus().sqrt().max(LEAST_COSINE).toConst()
  const index = square
    .oneMinus()
    .add(RED_ICE ** 2 - 1)
    .sqrt()
    .div(cosine)
  const least = asin(index.mul(0.5).min(1))
    .mul(2)
    .sub(60 * DEGREES)
  const cosViewLevel = cosView.mul(cosView).oneMinus().max(1e-4).sqrt().toConst()
  const level = cosViewLight.sub(cosView.mul(cosLight)).div(cosViewLevel.mul(cosine))
  const azimuth = acos(level.clamp(-1, 1)).sub(least).div(DEGREES).toConst() as Float
  const part = azimuth.add(DOG_START).div(DOG_RANGE).clamp().toConst() as Float
  const elevation = asin(sine).toConst() as Float
  const last = DOG_ELEVATIONS.length - 1
  const row = elevation.mul(last / (DOG_ELEVATIONS[last] * DEGREES))
  const width = 2 * HALF_TEXELS
  const u = part
    .pow(2 / 3)
    .mul(width - 1)
    .add(0.5)
    .div(width)
  const v = row.add(1.5).div(DOG_ELEVATIONS.length + 1)
  const above = asin(cosView.clamp(-1, 1))
    .sub(asin(cosLight.clamp(-1, 1)))
    .div(DOG_SPREAD * DEGREES)
  const height = above
    .mul(above)
    .mul(-0.5)
    .exp()
    .div(DOG_SPREAD * DEGREES * Math.sqrt(2 * Math.PI))
  // Before the first azimuth there is none; after the last, what is left runs out.
  const inside = smoothstep(0, 0.02, part).mul(smoothstep(0.7, 1, part).oneMinus())
  return sampleLevel0(table, vec2(u, v)).max(0).mul(height.mul(inside).div(cosViewLevel))
}
