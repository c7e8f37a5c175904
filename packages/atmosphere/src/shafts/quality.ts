/** Fineness of light shafts. */
interface Quality {
  /** Directions around the light that the shadow map tells apart. */
  readonly rows: number
  /** Distances from the line between camera and light that it tells apart. */
  readonly columns: number
  /** Pixels of the post effect from one that is marched to the next, in large pictures: see {@link spacingIn}. */
  readonly spacing: number
  /** Groups of samples along a view ray: places at which the lit air is evaluated. */
  readonly groups: number
  /** Samples of the shadow in each group, and in each slice of the volume for materials. */
  readonly samples: number
  /** Samples beyond the shadow maps of the light in each group, as of clouds. Fewer: steps in their shadows opposite the sun (*Anticrepuscular rays*). */
  readonly beyond: number
  /** Samples of the shadow in each medium, such as fog. */
  readonly inFog: number
}

export const qualities = {
  low: {
    rows: 960,
    columns: 120,
    spacing: 10,
    groups: 2,
    samples: 3,
    beyond: 6,
    inFog: 12
  },
  medium: {
    rows: 960,
    columns: 240,
    spacing: 8,
    groups: 3,
    samples: 3,
    beyond: 6,
    inFog: 32
  },
  high: {
    rows: 1024,
    columns: 256,
    spacing: 3,
    groups: 4,
    samples: 4,
    beyond: 3,
    inFog: 16
  },
  reference: {
    rows: 2048,
    columns: 512,
    spacing: 1,
    groups: 64,
    samples: 8,
    beyond: 7,
    inFog: 512
  }
} as const satisfies Record<string, Quality>

/** Fineness of the march of light shafts: `'reference'` has 512 samples a pixel, to compare others with, and takes 160 ms and more. */
export type LightShaftsQuality = keyof typeof qualities

/** Longer edge of pictures from which on they have a quality's spacing [pixels]. */
const FULL_WIDTH = 1920

/** Least spacing of smaller pictures [pixels]. */
const MIN_SPACING = 3

/** Pixels of a picture from one that is marched to the next: fewer in small pictures, which cost less. */
export const spacingIn = (spacing: number, width: number, height: number): number => {
  const scaled = Math.round((spacing * Math.max(width, height)) / FULL_WIDTH)
  return Math.min(spacing, Math.max(scaled, MIN_SPACING))
}

/** Names of all qualities. */
export const qualityNames = Object.keys(qualities) as LightShaftsQuality[]
