import type { CloudDeck } from './decks'

/** Light about a plane, for unit irradiance of the source of light on a plane across its rays, at one wavelength. */
export interface ClearLight {
  /** Direct irradiance of level planes: above the clouds over the plane, and on the clouds below it. */
  readonly direct: { readonly above: number; readonly below: number }
  /** Sky irradiance of level planes: there, and on the clouds below. */
  readonly sky: { readonly here: number; readonly below: number }
  /** Irradiance of a level plane there that faces down. */
  readonly ground: number
  /** Sky irradiance of the plane itself. */
  readonly plane: number
  readonly albedo: number
}

/**
 * Irradiance of a plane among clouds: of sky and ground, with the direct light that clouds have scattered,
 * but without what arrives unscattered. Light to and fro between clouds and ground is summed as geometric
 * series. Float64 twin of the shader function in tsl/overcast.ts; another, bounce by bounce, is in test/twins/overcast.ts.
 *
 * @param above - Clouds above the plane.
 * @param below - Clouds below it.
 * @param cosNormal - The plane's normal against the zenith.
 */
export function cloudyIrradiance(
  { direct, sky, ground, plane, albedo }: ClearLight,
  above: CloudDeck,
  below: CloudDeck,
  cosNormal: number
): number {
  const reflected = 1 - below.diffuse
  /** Part of the light on the ground that leaves the clouds over it. */
  const escaping = below.diffuse / (1 - albedo * reflected)
  const whiteness = reflected + albedo * escaping * below.diffuse
  const passing = direct.above * above.direct + sky.here * above.diffuse
  const bounced = passing / (1 - whiteness * (1 - above.diffuse))
  // What is more than the clear sky's own part, from all over the upper half.
  const more = bounced - direct.above * above.beam - sky.here * above.diffuse
  const beam = direct.below * above.beam
  const diffuse = sky.below * above.diffuse + more
  const onGround = (beam * below.direct + diffuse * below.diffuse) * escaping
  const fromClouds = beam * (1 - below.direct) + diffuse * reflected
  const part = onGround / Math.max(direct.below + sky.below, 1e-20)
  const lower = ground * (part - above.diffuse) + fromClouds
  const irradiance =
    above.diffuse * plane + (more * (1 + cosNormal)) / 2 + (lower * (1 - cosNormal)) / 2
  return Math.max(irradiance, 0)
}
