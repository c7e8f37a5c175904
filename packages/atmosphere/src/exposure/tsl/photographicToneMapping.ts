import { agxToneMapping, luminance, max, mix, vec3 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import type { Float, Vec3 } from '../../tsl-types'

/** Look of `photographicToneMapping`. */
export interface PhotographicLook {
  /** Slope at middle grey of the display, in its own code values; 1 is AgX as it is, default 1.5 [–]. */
  contrast?: number
  /** Saturation after the contrast, which itself adds some; 0 is grey, default 1.1 [–]. */
  saturation?: number
  /** Light that looks white, linear sRGB of any brightness; default sunlight above the air. `[1, 1, 1]` balances nothing: greys are mauve. */
  white?: readonly [number, number, number]
}

/** Sunlight above the air, linear sRGB over its green: pinker than the display's white, D65. */
export const SUNLIGHT = [1.116, 1, 0.978] as const

/** Part of the curve that is AgX's own, at black; falls to 0 at white: keeps drawing in shadows and nights [–]. */
const SHADOWS = 0.6

/** Exponent that stands for the display's transfer function, as in AgX [–]. */
const DISPLAY_GAMMA = 2.2

/**
 * Tone mapping with the contrast of a photograph: white balance, AgX, then an S-curve about middle grey and saturation.
 *
 * AgX alone leaves room for a grading: white clouds stay light grey, and haze looks flat. The curve is log-logistic,
 * `x^c / (x^c + (1 − x)^c)` for each code value x of the display, gentler in the shadows: black, middle grey and white stay
 * where they are, and nothing is cut off, so what `autoExposure` says about clipped highlights holds.
 *
 * @param look - Contrast, saturation and white.
 * @returns A tone mapping for `renderer.library.addToneMapping(…, CustomToneMapping)`: takes exposed light (linear sRGB) and a
 * factor of brightness, gives linear sRGB in [0, 1].
 * @throws Error if a contrast or a component of white is not > 0, or a saturation not ≥ 0.
 */
export function photographicToneMapping({
  contrast = 1.5,
  saturation = 1.1,
  white = SUNLIGHT
}: PhotographicLook = {}): (color: Node, exposure: Node) => Node {
  if (!(contrast > 0 && contrast < Infinity)) {
    throw new Error(`photographicToneMapping: contrast must be > 0, got ${contrast}`)
  }
  if (!(saturation >= 0 && saturation < Infinity)) {
    throw new Error(`photographicToneMapping: saturation must be ≥ 0, got ${saturation}`)
  }
  if (white.length !== 3 || !white.every(value => value > 0 && value < Infinity)) {
    throw new Error(`photographicToneMapping: white must be three numbers > 0, got ${white}`)
  }
  const [red, green, blue] = white
  const whiteLuminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue
  const balance = vec3(...white.map(value => whiteLuminance / value))
  return (color, exposure) => {
    const mapped = agxToneMapping((color as Vec3).mul(balance), exposure) as Vec3
    const code = mapped
      .pow(1 / DISPLAY_GAMMA)
      .clamp(0, 1)
      .toConst() as Vec3
    const light = code.pow(contrast)
    const dark = code.oneMinus().pow(contrast)
    const curve = light.div(light.add(dark))
    const curved = mix(curve, code, code.oneMinus().mul(SHADOWS)).toConst() as Vec3
    const grey = vec3(luminance(curved) as unknown as Float)
    return max(mix(grey, curved, saturation), 0)
      .min(1)
      .pow(DISPLAY_GAMMA)
  }
}
