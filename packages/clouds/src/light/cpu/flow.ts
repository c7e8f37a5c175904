/**
 * Anisotropy of light scattered more than once in isolated clouds, relative to that in a slab: what has left through the sides does not come
 * back, so that light flows on along the light's ray, and out to the sides. Terms of its source over its mean, with D the scaled optical
 * diameter: along the ray χ′₁² a / (1 + (1 − g′) D / b), with [a, b] of `along`, χ′₂ of its square, and 3 χ′₁ at a sphere's sides.
 *
 * Rounded from means over the light of Monte-Carlo solutions of spheres (`npm run fit-leak` prints them) with D from 0.6 to 40 and χ′₁ from
 * 0.17 to 0.61.
 */
export const flowFit = {
  along: [1.2, 10],
  square: [1.35, 2],
  aside: [0.4, 9]
} as const
