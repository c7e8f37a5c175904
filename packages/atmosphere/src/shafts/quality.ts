/**
 * Directions around the light that the shadow map tells apart, and distances from the line between it and the camera; pixels from one that is marched to the next, see {@link spacingIn};
 * groups of samples along a view ray, and samples in each; samples in fog. In materials: rays along the longer edge of the picture,
 * and samples in each slice of a ray; no rays where each fragment marches.
 */
export const qualities = {
  low: {
    rows: 960,
    columns: 60,
    spacing: 10,
    groups: 2,
    samples: 3,
    inFog: 12,
    rays: 128,
    looks: 2
  },
  medium: {
    rows: 960,
    columns: 240,
    spacing: 6,
    groups: 3,
    samples: 3,
    inFog: 14,
    rays: 144,
    looks: 3
  },
  high: {
    rows: 1024,
    columns: 256,
    spacing: 3,
    groups: 4,
    samples: 4,
    inFog: 16,
    rays: 144,
    looks: 4
  },
  reference: {
    rows: 2048,
    columns: 512,
    spacing: 1,
    groups: 64,
    samples: 8,
    inFog: 512,
    rays: 0,
    looks: 0
  }
} as const

/** Fineness of the march of light shafts. */
export type LightShaftsQuality = keyof typeof qualities

/** Longer edge of a picture that has a quality's spacing, as larger ones have [pixels]; and the least spacing of smaller ones. */
const FULL_WIDTH = 1920
const LEAST_SPACING = 3

/** Pixels of a picture from one that is marched to the next: fewer in small pictures, which cost less. */
export const spacingIn = (spacing: number, width: number, height: number): number => {
  const scaled = Math.round((spacing * Math.max(width, height)) / FULL_WIDTH)
  return Math.min(spacing, Math.max(scaled, LEAST_SPACING))
}

/** Names of all qualities. */
export const qualityNames = Object.keys(qualities) as LightShaftsQuality[]
