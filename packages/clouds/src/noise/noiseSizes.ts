/** Texels along an edge of the noise textures. */
export const NOISE_SIZE = { shape: 128, detail: 64, weather: 64 } as const

export type NoiseName = keyof typeof NOISE_SIZE
