import type { CloudDeck } from '../../src/environment/cpu/decks'
import type { ClearLight } from '../../src/environment/cpu/overcast'

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
