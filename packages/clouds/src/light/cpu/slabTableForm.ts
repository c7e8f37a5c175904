/** Number of angles of the light. */
const lightAngles = 16

/** Layout of the cloud-light table: a 3-D texture of positions × thicknesses × layers. */
export const slabTableForm = {
  /** Positions in a slab. */
  positions: 32,
  /** Thicknesses of slabs. */
  thicknesses: 28,
  lightAngles,
  /** Layers: four moments for each angle of the light, two more for each, the sky's. */
  layers: 2 * lightAngles + 1,
  /** Depths well below this are spaced evenly, those well above it by their logarithm [scaled optical depth]. */
  bend: 0.25,
  /** Scaled optical thickness of the thickest slab; thicker ones look like it from their ends. */
  thickest: 200
} as const
