// What the cloud-light table holds.

/** Positions in a slab. */
export const positions = 32

/** Thicknesses of slabs. */
export const thicknesses = 28

/** Angles of the light. */
export const lightAngles = 16

/** Layers of its 3-D texture: four moments per angle of the light, two more per angle, the sky's. */
export const layers = 2 * lightAngles + 1
