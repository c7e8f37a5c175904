import { dot, Fn, If, mix, smoothstep, vec3 } from 'three/tsl'
import type { Float, Vec3 } from '../../tsl-types'

/** Mesopic range [cd/m²]: only rods see below it, only cones above it. CIE 191:2010. */
const MESOPIC = [0.005, 5] as const

// Rows of linear sRGB to CIE XYZ: X, Y, and the sum X + Y + Z.
const X = [0.4124564, 0.3575761, 0.1804375] as const
const Y = [0.2126729, 0.7151522, 0.072175] as const
const SUM = [0.6444632, 1.1919203, 1.2029166] as const

/** Scotopic over photopic luminance of white (D65), by the fit of Larson et al. */
const WHITE_RATIO = 2.572916

/**
 * Colour of what rods see, of luminance 1: chromaticity (0.27, 0.277). Tone mappings add contrast, so a picture shows about
 * (0.25, 0.25), the mean hue of night paintings (Jensen et al. 2000); taken before them, that would show as navy blue.
 */
const NIGHT = [0.806139, 0.999199, 1.579175] as const

/** Darkest X that a ratio is taken of, far below what half floats hold. */
const LEAST = 1e-12

/** Eyes that see a picture. */
export interface Sight {
  /** Picture's unit per luminance, > 0 [1/(cd/m²)]. */
  luminanceScale: Float
  /** Luminance that the eyes are adapted to, > 0 [cd/m²]: no pixel is seen as one darker than that. */
  adaptation: Float
  /** Strength in [0, 1]; 0 leaves the colour as it is. */
  strength: Float
}

/**
 * Colour as eyes see it in the dark: with rods, which tell no colours and respond to blue rather than to red light. A
 * bluish grey replaces it below 0.005 cd/m², in parts up to 5 cd/m²; above, it stays as it is.
 *
 * White keeps its luminance, red becomes darker and blue brighter (Purkinje's shift). A pixel counts by its own luminance or
 * that of adaptation, whichever is greater: lamps keep their colours by night, and shadows theirs by day.
 *
 * @param color - Linear sRGB.
 * @returns Linear sRGB in the same unit.
 * @see Larson, Rushmeier & Piatko 1997, "A visibility matching tone reproduction operator": scotopic luminance
 *   `V = Y (1.33 (1 + (Y + Z)/X) − 1.68)`. Jensen et al. 2000, "Night rendering": smoothstep of log luminance, and the
 *   night's hue. Twin: test/twins/exposure/purkinjeShift.ts
 */
export const purkinjeShift = (color: Vec3, { luminanceScale, adaptation, strength }: Sight): Vec3 =>
  Fn(() => {
    const seen = color.toVar() as Vec3
    const photopic = dot(seen, vec3(...Y)).toConst() as Float
    const luminance = photopic.div(luminanceScale).max(adaptation).toConst() as Float
    // By day no pixel does.
    If(luminance.lessThan(MESOPIC[1]), () => {
      // 1 + (Y + Z)/X is the sum over X.
      const ratio = dot(seen, vec3(...SUM)).div(dot(seen, vec3(...X)).max(LEAST))
      const scotopic = photopic.mul(ratio.mul(1.33).sub(1.68)).div(WHITE_RATIO)
      const [dark, bright] = MESOPIC.map(Math.log2)
      const rods = smoothstep(dark, bright, luminance.log2()).oneMinus().mul(strength)
      seen.assign(mix(seen, vec3(...NIGHT).mul(scotopic.max(0)), rods))
    })
    return seen
  })()
