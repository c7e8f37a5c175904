/** Middle of the lake, its half axes and the height of its water [m]. */
export const LAKE = { x: 150, z: -1750, halfWidth: 520, halfLength: 1500, height: 0 } as const
/** Middle of the village [m]. */
export const VILLAGE = { x: 420, z: 230 } as const
