// Exponent of the share of a slab's multiply scattered light that a ball keeps: a polynomial in the
// sample's part of the way through the cloud along the sun's axis, x; in ln(1 + (1 − χ′₁) D), D the
// ball's scaled optical diameter; and in the length of that way over the diameter, q.
//
// Fitted by scripts/fit-leak.ts to Monte-Carlo solutions of balls with D from 0.3 to 40 and χ′₁ from 0
// to 0.61, against slabs of thickness qD with the sun at their zenith: within 9 % (root mean square,
// weighted by the light), where slabs alone are off by factors of 2 to 10.

export const constant = 0.4876
export const part = 0.2232
export const depth = -0.373
export const chord = -2.6435
export const part2 = -0.1733
export const depth2 = -0.0288
export const chord2 = 0.9428
export const partDepth = -0.5389
export const partChord = 0.0721
export const depthChord = 0.8093

/** Largest scaled optical diameter that the fit knows; beyond it the leak stays as it is there. */
export const deepestPuff = 40
