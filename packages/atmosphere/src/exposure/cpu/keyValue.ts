/** Luminance below which only rods see [cd/m²]. */
const SCOTOPIC_LUMINANCE = 0.01

/**
 * Power of luminance by which pictures darken below {@link SCOTOPIC_LUMINANCE}, found by looking: 0 makes a
 * moonless night as bright as a moonlit one, larger ones leave it black. Story: Day, Night.
 */
const SCOTOPIC_POWER = 0.3

/**
 * Key value of a scene: brightness of its picture for the luminance that the eye has adapted to.
 *
 * @see Krawczyk, Myszkowski & Seidel 2005, "Lightness perception in tone reproduction", eq. 11: the key
 *   falls from 0.7 in daylight to 0.03 where only rods see. Below 0.01 cd/m² the power of 0.3 is ours:
 *   a moonless night stays darker than one with a moon.
 */
export function keyValue(luminance: number): number {
  const key = 1.03 - 2 / (2 + Math.log10(luminance + 1))
  return key * (luminance / (luminance + SCOTOPIC_LUMINANCE)) ** SCOTOPIC_POWER
}
