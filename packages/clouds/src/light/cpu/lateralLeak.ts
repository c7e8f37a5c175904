/**
 * Exponent of the lateral leak, the share of a slab's multiply scattered light that a sphere keeps: a polynomial in
 * the sample's part of the path through the cloud along the ray of light, x; in ln(1 + (1 − g′) D), y, with D the
 * sphere's scaled optical diameter; and in the length of that path over the diameter, z.
 *
 * Fitted by scripts/fit-leak.ts to Monte-Carlo solutions of spheres with D from 0.3 to 40 and g′ from 0 to
 * 0.61, against slabs of thickness zD with the light at their zenith: within 9 % (root mean square, weighted
 * by the light), where slabs alone are off by factors of 2 to 10.
 */
export const lateralLeakFit = {
  constant: 0.4876,
  linear: [0.2232, -0.373, -2.6435],
  squares: [-0.1733, -0.0288, 0.9428],
  /** Coefficients of xy, yz and zx. */
  products: [-0.5389, 0.8093, 0.0721],
  /** Largest scaled optical diameter that the fit knows; the leak of larger ones is taken to be the same. */
  largestDiameter: 40,
  /**
   * Logarithm that openness along the view ray and along the vertical takes, and scale of a chord's depth
   * [1/transport depth]. Rounded from a fit to Monte-Carlo solutions in 13 clouds of a large-eddy simulation and suns from 3° to 80°; none
   * of them is the cloud of `validate --cloud-light`.
   */
  view: 1.4,
  vertical: 0.8,
  chordDepth: 0.74,
  /**
   * Gaps on the ray of light, in which scattered light spreads. They take, by the logarithm of the part that is filled: `weight` times what
   * ln(1 + depth to the light) + ½ ln(1 + depth behind) is over `from`; less in clouds much deeper than `depth`, which have other reasons to
   * be thin in the mean: anvils. The ends of a cloud are thin, too: no part is less than `least`. Rounded, as `around`, from a
   * fit to path-traced pictures of five clouds of a large-eddy simulation, none of them that cloud, and of a simulated thunderstorm.
   */
  gaps: { weight: 0.23, from: 0.8, depth: 20, least: 0.03 },
  /** Logarithm of what comes round to the shaded end of a cloud with bays and lobes, per logarithm of 1 + the depth there. */
  around: 0.24,
  /** Scaled depth at which rays end, −ln of `LEAST_TRANSMITTANCE`. */
  seenDepth: 4.605,
  /** Diameter over the mean chord of a sphere. */
  diameterPerChord: 1.5,
  /**
   * Diameter over chord of clouds that are not resolved one by one, whose depths are of their mean extinction: under a
   * level light, its change to the zenith; and weight of their chords along view ray and vertical. By these they are within 20 %
   * as bright as resolved ones (e2e/gpu/clouds/far).
   */
  unresolvedDiameter: [1.35, -0.21],
  unresolvedChords: 0.4
} as const
