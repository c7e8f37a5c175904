/**
 * Share of an isolated cloud's light from sky and ground that the sky has: turned upside down it is the ground's share.
 * Its logit is power ln((face + b) / (face + a)) + μ (slope + thinSlope e^{−decay (a + b)}), with a and b the scaled depths
 * to top and base and μ of the view ray against the local up. Between two diffuse hemispheres a slab's is ln of that ratio;
 * a cloud has less, because light enters it from its sides, too. Rounded from a fit to Monte-Carlo solutions of 24,000 places
 * that are seen in clouds of a large-eddy simulation of cumulus and 8,000 in a thunderstorm.
 */
export const skyShareFit = {
  face: 1,
  power: 0.52,
  slope: -1.4,
  thinSlope: 2.05,
  decay: 0.04
} as const
