/** What light does to an infinite slab, or to several at once: parts of unit flux. */
export interface CloudSheet {
  /** Of diffuse light that passes. Clouds absorb nothing: the rest is reflected. */
  readonly diffuse: number
  /** Of the sun's rays that passes, diffusely or not. */
  readonly direct: number
  /** Of the sun's rays that passes without scattering, but into the forward peak. */
  readonly beam: number
}

/** A layer of clouds of the same optical depth that cover a part of the sky. */
export interface CloudCover {
  /** Scaled optical thickness. */
  readonly thickness: number
  /** Part of the sky. */
  readonly cover: number
}

/** A sun lower than this is as good as that. */
export const LOWEST_OVERCAST_SUN = 0.05

/**
 * Part of the sun's light that a cloud passes that does not absorb, in Eddington's approximation.
 *
 * @param thickness - Scaled optical thickness.
 * @param cosSun - μ_s, in (0, 1].
 * @param diffusing - 1 − χ′₁.
 * @see King & Harshvardhan 1986, "Comparative accuracy of selected multiple scattering approximations"
 */
export function eddingtonTransmittance(
  thickness: number,
  cosSun: number,
  diffusing: number
): number {
  const beam = Math.exp(-thickness / cosSun)
  return (2 + 3 * cosSun + (2 - 3 * cosSun) * beam) / (4 + 3 * diffusing * thickness)
}

/** The same for light from all of the sky: 1/(1 + ¾ (1 − χ′₁) τ′). */
export function eddingtonDiffuse(thickness: number, diffusing: number): number {
  return 4 / (4 + 3 * diffusing * thickness)
}

/**
 * Layers one above the other, each broken. Between sheets that absorb nothing, light goes to and fro until
 * 1/t − 1 add up, in whatever order.
 */
export function stackSheets(
  layers: readonly CloudCover[],
  cosSun: number,
  diffusing: number
): CloudSheet {
  const mu = Math.max(cosSun, LOWEST_OVERCAST_SUN)
  const mean = (cover: number, through: number): number => 1 - cover + cover * through
  const series = (parts: number[]): number =>
    1 / parts.reduce((sum, part) => sum + 1 / part, 1 - parts.length)
  return {
    diffuse: series(
      layers.map(({ cover, thickness }) => mean(cover, eddingtonDiffuse(thickness, diffusing)))
    ),
    direct: series(
      layers.map(({ cover, thickness }) =>
        mean(cover, eddingtonTransmittance(thickness, mu, diffusing))
      )
    ),
    beam: layers.reduce(
      (part, { cover, thickness }) => part * mean(cover, Math.exp(-thickness / mu)),
      1
    )
  }
}

/** Light about a plane, of unit irradiance of the sun on a plane across its rays, at one wavelength. */
export interface ClearLight {
  /** Of the sun on level planes: at the plane, above the clouds over it, and on the clouds below it. */
  readonly sun: { readonly above: number; readonly below: number }
  /** Of the sky on level planes: there, and on the clouds below. */
  readonly sky: { readonly here: number; readonly below: number }
  /** On a level plane that faces down there. */
  readonly ground: number
  /** Of the plane itself. */
  readonly plane: number
  readonly albedo: number
}

/**
 * Irradiance of a plane among clouds: of sky and ground, with the sun's light that clouds have scattered
 * but without what comes straight from the sun. Float64 twin of the shader function: here light goes to
 * and fro between clouds and ground one time after the other.
 *
 * @param above - Clouds above the plane.
 * @param below - Clouds below it.
 * @param cosNormal - The plane's normal against the zenith.
 */
export function cloudyIrradiance(
  clear: ClearLight,
  above: CloudSheet,
  below: CloudSheet,
  cosNormal: number
): number {
  const { sun, sky, albedo } = clear
  /** What goes up of a flux down: by the clouds below, and by white ground among whose light it counts. */
  const reflect = (diffuse: number, beam: number): { clouds: number; ground: number } => {
    const clouds = diffuse * (1 - below.diffuse) + beam * (1 - below.direct)
    let ground = 0
    let down = diffuse * below.diffuse + beam * below.direct
    for (let bounce = 0; bounce < 400; bounce++) {
      ground += down * below.diffuse
      down *= albedo * (1 - below.diffuse)
    }
    return { clouds, ground }
  }
  const beam = sun.above * above.beam
  let down = sun.above * above.direct + sky.here * above.diffuse
  let wave = down
  for (let bounce = 0; bounce < 400; bounce++) {
    const { clouds, ground } = reflect(wave, 0)
    wave = (clouds + albedo * ground) * (1 - above.diffuse)
    down += wave
  }
  // What is more than the clear sky's own part, from all over the upper half.
  const more = down - beam - sky.here * above.diffuse
  const onClouds = sky.below * above.diffuse + more
  const up = reflect(onClouds, sun.below * above.beam)
  const fromBelow = up.clouds + (clear.ground * up.ground) / (sun.below + sky.below)
  const lower = fromBelow - above.diffuse * clear.ground
  return Math.max(
    above.diffuse * clear.plane + (more * (1 + cosNormal)) / 2 + (lower * (1 - cosNormal)) / 2,
    0
  )
}
