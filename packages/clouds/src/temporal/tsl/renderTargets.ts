import type { Float, LevelTexture, Vec2, Vec4 } from '../../tsl-types'

/**
 * Textures of a render target of clouds. What `distances` holds depends on the target:
 *
 * - marched: log₂ of the clouds' distance, log₂ of the distance of what was drawn, what `clearAir` reads, steps over 256
 * - cells: see `Cell`
 * - history: the same two distances and the accumulated samples as bytes: see `pack`
 */
export interface CloudTargets {
  /** Light in front of the pixel, air included, times `FrameUniforms.gain`; transmittance in alpha. */
  readonly light: LevelTexture<Vec2>
  readonly distances: LevelTexture<Vec2>
}

/** Transmittance above which a pixel counts as clear. */
export const CLEAR = 0.999

/** Brightness of a colour, (r + 2g + b)/4: statistics and clipping work on it and on transmittance. */
export const brightness = ({ x, y, z }: Vec4): Float => x.add(y.mul(2)).add(z).mul(0.25)
