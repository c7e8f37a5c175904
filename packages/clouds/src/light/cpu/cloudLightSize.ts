// What the cloud-light table holds.

/** Positions in a slab. */
export const positions = 32

/** Thicknesses of slabs. */
export const depths = 28

/** Sun angles. */
export const suns = 16

/** Layers of its 3-D texture: four moments per sun angle, two more per sun angle, the sky's. */
export const layers = 2 * suns + 1
