import type { Octaves } from '../../noise/cpu/fractalSum'

/** Patches of one material and another: from 4 km to 64 m. */
export const PATCHES: Octaves = { count: 7, inverse: 2 ** -12, gain: 0.7, seed: 211 }

/** Patches that one sees from orbit: from 32 km to 8 km. Without: land from 10 km and 400 km is one film (*Terrain*). */
export const BROAD_PATCHES: Octaves = { count: 3, inverse: 2 ** -15, gain: 1, seed: 231 }

/** Factor on them. */
export const BROAD = 0.5

/** Dry and wet country: from 1,050 km to 16 km. */
export const CLIMATE: Octaves = { count: 7, inverse: 2 ** -20, gain: 0.6, seed: 401 }
