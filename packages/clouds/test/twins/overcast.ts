import { LOWEST_COSINE } from '../../src/environment/tsl/decks'

/** Transmittances of a cloud deck, or of several at once: parts of unit flux. */
export interface CloudDeck {
  /** Diffuse light that passes. Clouds absorb nothing: the rest is reflected. */
  readonly diffuse: number
  /** Direct light that passes, scattered or not. */
  readonly direct: number
  /** Direct light that passes unscattered, or scattered within the forward peak. */
  readonly beam: number
}

/** Broken layer: clouds of one optical depth over a part of the sky. */
export interface CloudCover {
  /** Scaled optical thickness. */
  readonly thickness: number
  /** Part of the sky. */
  readonly coverage: number
}

/**
 * Transmittance of a cloud that absorbs nothing for light from one direction, in Eddington's approximation.
 *
 * @param thickness - Scaled optical thickness.
 * @param cosLight - μ_s, in (0, 1].
 * @param oneMinusAsymmetry - 1 − g′.
 * @see King & Harshvardhan 1986, "Comparative accuracy of selected multiple scattering approximations"
 */
export function eddingtonTransmittance(
  thickness: number,
  cosLight: number,
  oneMinusAsymmetry: number
): number {
  const beam = Math.exp(-thickness / cosLight)
  return (2 + 3 * cosLight + (2 - 3 * cosLight) * beam) / (4 + 3 * oneMinusAsymmetry * thickness)
}

/** Transmittance for diffuse light: 1/(1 + ¾ (1 − g′) τ′). */
export function eddingtonDiffuse(thickness: number, oneMinusAsymmetry: number): number {
  return 4 / (4 + 3 * oneMinusAsymmetry * thickness)
}

/**
 * Transmittances of broken layers one above the other. Light between decks that absorb nothing goes to and
 * fro until 1/t − 1 add up, in whatever order.
 */
export function stackDecks(
  layers: readonly CloudCover[],
  cosLight: number,
  oneMinusAsymmetry: number
): CloudDeck {
  const mu = Math.max(cosLight, LOWEST_COSINE)
  const mean = (coverage: number, through: number): number => 1 - coverage + coverage * through
  const series = (parts: number[]): number =>
    1 / parts.reduce((sum, part) => sum + 1 / part, 1 - parts.length)
  return {
    diffuse: series(
      layers.map(({ coverage, thickness }) =>
        mean(coverage, eddingtonDiffuse(thickness, oneMinusAsymmetry))
      )
    ),
    direct: series(
      layers.map(({ coverage, thickness }) =>
        mean(coverage, eddingtonTransmittance(thickness, mu, oneMinusAsymmetry))
      )
    ),
    beam: layers.reduce(
      (part, { coverage, thickness }) => part * mean(coverage, Math.exp(-thickness / mu)),
      1
    )
  }
}

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
 * but without what arrives unscattered. Float64 twin of the shader function: here light goes to
 * and fro between clouds and ground one time after the other.
 *
 * @param above - Clouds above the plane.
 * @param below - Clouds below it.
 * @param cosNormal - The plane's normal against the zenith.
 */
export function cloudyIrradiance(
  clear: ClearLight,
  above: CloudDeck,
  below: CloudDeck,
  cosNormal: number
): number {
  const { direct, sky, albedo } = clear
  /** Flux that goes up for a flux down: off the clouds below, and off white ground under them. */
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
  const beam = direct.above * above.beam
  let down = direct.above * above.direct + sky.here * above.diffuse
  let wave = down
  for (let bounce = 0; bounce < 400; bounce++) {
    const { clouds, ground } = reflect(wave, 0)
    wave = (clouds + albedo * ground) * (1 - above.diffuse)
    down += wave
  }
  // What is more than the clear sky's own part, from all over the upper half.
  const more = down - beam - sky.here * above.diffuse
  const onClouds = sky.below * above.diffuse + more
  const up = reflect(onClouds, direct.below * above.beam)
  const fromBelow = up.clouds + (clear.ground * up.ground) / (direct.below + sky.below)
  const lower = fromBelow - above.diffuse * clear.ground
  return Math.max(
    above.diffuse * clear.plane + (more * (1 + cosNormal)) / 2 + (lower * (1 - cosNormal)) / 2,
    0
  )
}
