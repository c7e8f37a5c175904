export type Triple = [number, number, number]

/** CIE XYZ of D65 for Y = 1. */
export const D65: Readonly<Triple> = [0.95047, 1, 1.08883]

const radians = Math.PI / 180

/**
 * CIE L*a*b* under D65.
 *
 * @param xyz - Tristimulus values of the colour.
 * @param whiteY - Y of the white that counts as L* = 100, same unit.
 */
export function xyzToLab(xyz: Readonly<Triple>, whiteY: number): Triple {
  const [x, y, z] = xyz.map((value, i) => {
    const t = value / (D65[i] * whiteY)
    return t > (6 / 29) ** 3 ? Math.cbrt(t) : t / (3 * (6 / 29) ** 2) + 4 / 29
  }) as Triple
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)]
}

/** Hue angle of (a, b) [°], in [0, 360); 0 for grey. */
function hueDegrees(a: number, b: number): number {
  if (a === 0 && b === 0) return 0
  const degrees = Math.atan2(b, a) / radians
  return degrees < 0 ? degrees + 360 : degrees
}

/**
 * The colour difference ΔE₀₀ of two L*a*b* colours, all weights 1.
 *
 * @see Sharma, Wu & Dalal 2005, "The CIEDE2000 color-difference formula", equations 2–22
 */
export function ciede2000(first: Readonly<Triple>, second: Readonly<Triple>): number {
  const [l1, a1, b1] = first
  const [l2, a2, b2] = second
  const meanChroma = (Math.hypot(a1, b1) + Math.hypot(a2, b2)) / 2
  const stretch = (chroma: number): number => Math.sqrt(chroma ** 7 / (chroma ** 7 + 25 ** 7))
  const factor = 1 + 0.5 * (1 - stretch(meanChroma))
  const c1 = Math.hypot(factor * a1, b1)
  const c2 = Math.hypot(factor * a2, b2)
  const h1 = hueDegrees(factor * a1, b1)
  const h2 = hueDegrees(factor * a2, b2)

  const isGrey = c1 * c2 === 0
  let hueStep = isGrey ? 0 : h2 - h1
  if (hueStep > 180) hueStep -= 360
  else if (hueStep < -180) hueStep += 360
  const deltaL = l2 - l1
  const deltaC = c2 - c1
  const deltaH = 2 * Math.sqrt(c1 * c2) * Math.sin((hueStep / 2) * radians)

  const meanL = (l1 + l2) / 2
  const meanC = (c1 + c2) / 2
  let meanH = h1 + h2
  if (!isGrey) {
    if (Math.abs(h1 - h2) <= 180) meanH /= 2
    else meanH = meanH < 360 ? (meanH + 360) / 2 : (meanH - 360) / 2
  }
  const cosine = (degrees: number): number => Math.cos(degrees * radians)
  const hueWeight =
    1 -
    0.17 * cosine(meanH - 30) +
    0.24 * cosine(2 * meanH) +
    0.32 * cosine(3 * meanH + 6) -
    0.2 * cosine(4 * meanH - 63)
  const turn = 30 * Math.exp(-(((meanH - 275) / 25) ** 2))
  const weightL = 1 + (0.015 * (meanL - 50) ** 2) / Math.sqrt(20 + (meanL - 50) ** 2)
  const weightC = 1 + 0.045 * meanC
  const weightH = 1 + 0.015 * meanC * hueWeight
  const rotation = -Math.sin(2 * turn * radians) * 2 * stretch(meanC)
  const l = deltaL / weightL
  const c = deltaC / weightC
  const h = deltaH / weightH
  return Math.sqrt(l * l + c * c + h * h + rotation * c * h)
}
