import { keyValue } from './keyValue'

/** Mean luminance of a picture of daylight [–]: tone mappings (AgX, ACES) show it half as bright as white, in sRGB. */
export const MIDDLE_GREY = 0.17

/** Luminance in daylight, whose picture is the mean of all [cd/m²]. */
const DAYLIGHT_LUMINANCE = 5000

/**
 * Most that the upper percentile becomes [–]. `AgXToneMapping` has white at 16, `ACESFilmicToneMapping` shows 98 % of it
 * at 8.
 */
const HIGHLIGHT = 8

/** Luminance that a tenth of the picture may exceed [–]: shown as 0.85 of white in sRGB by `photographicToneMapping`. */
const LIGHT = 0.8

/** Luminance up to which a tenth of what is beside black is made brighter [–]: 0.78 of white. More: seas are pale from orbit. */
const BESIDE_BLACK = 0.6

/** Settings of an automatic exposure that need no picture. */
export interface ExposureSettings {
  /** Brightness over what is metered [EV]. */
  compensation: number
  /** Least and greatest luminance that is exposed for [cd/m²]. */
  limits: readonly [number, number]
  /** True if pictures of dark scenes are darker. */
  darkNights: boolean
  /** Part, in [0, 1], of the stops by which the brightest tenth is over {@link LIGHT}: the picture is darkened by it. */
  highlightPriority: number
}

/** Luminances that a picture is exposed for [cd/m²]. */
export interface MeteredLuminance {
  /** Mean, in logarithms. */
  mean: number
  /** Exceeded by a tenth of what is not black. */
  light: number
  /** Upper percentile. */
  bright: number
  /** Part of the picture that is not black, or as good as black beside the rest, in (0, 1] [–]. */
  seen: number
}

/**
 * Luminance of a picture: middle grey in daylight; where only rods see, as dark as eyes see it. In between the
 * reciprocals add up, so that dusk is a little darker than day: 0.14 at 10 cd/m², 0.09 at 1 cd/m².
 *
 * @param luminance - Metered luminance, > 0 [cd/m²].
 */
const pictureLuminance = (luminance: number): number =>
  1 / (1 / MIDDLE_GREY + 1 / keyValue(luminance) - 1 / keyValue(DAYLIGHT_LUMINANCE))

/**
 * Scale by which a metered luminance shows as middle grey, or darker by night.
 *
 * Beside black, such as space, what is seen is brighter: the mean light of the whole picture stays, up to where the brightest
 * tenth is at {@link BESIDE_BLACK}. So a planet before space has bright clouds, and its seas keep their blue.
 *
 * @param metered - Luminances, each > 0.
 * @returns `luminanceScale`, > 0 [1/(cd/m²)].
 */
export function exposedScale(
  metered: MeteredLuminance,
  { compensation, limits, darkNights, highlightPriority }: ExposureSettings
): number {
  const [least, greatest] = limits
  const [luminance, light, bright] = [metered.mean, metered.light, metered.bright].map(value =>
    Math.min(Math.max(value, least), greatest)
  )
  /** Scale of an even picture. */
  const evenScale = (of: number): number => (darkNights ? pictureLuminance(of) : MIDDLE_GREY) / of
  const even = evenScale(luminance)
  const excess = Math.max((light * even) / LIGHT, 1)
  // The room is that of day: nights stay night.
  const room = (BESIDE_BLACK / MIDDLE_GREY) * (luminance / light)
  const besideBlack = Math.max(Math.min(1 / metered.seen, room), 1)
  const brighter = Math.min(even * besideBlack, evenScale(least))
  const scale = brighter * excess ** -highlightPriority
  return 2 ** compensation * Math.min(scale, HIGHLIGHT / bright)
}

/**
 * Scale on its way to another: exponential in stops, as eyes and cameras count.
 *
 * @param seconds - Time since `from`, ≥ 0 [s].
 * @param timeConstant - Time in which 63 % of the stops are taken, ≥ 0; 0 takes all [s].
 */
export function adaptedScale(
  from: number,
  to: number,
  seconds: number,
  timeConstant: number
): number {
  const rest = timeConstant > 0 ? Math.exp(-seconds / timeConstant) : 0
  return to * (from / to) ** rest
}
