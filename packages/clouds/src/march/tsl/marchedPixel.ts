import { uv } from 'three/tsl'
import { blueNoise } from '../../temporal/tsl/noisePattern'
import type { Float, LevelTexture, Vec2 } from '../../tsl-types'
import type { FrameInputs } from './viewRay'

/** Textures of the march: what rays see, not lit yet. */
export interface MarchedTargets {
  /** Distances of `SeenPoints` [m], and their shares. */
  readonly distances: LevelTexture<Vec2>
  readonly shares: LevelTexture<Vec2>
  /** log₂ of the clouds' distance, log₂ of the distance of what was drawn, transmittance, `packFound`. */
  readonly ray: LevelTexture<Vec2>
}

/** Pixel of each block that is marched, of a picture with one texel for each block. */
export function marchedPixel({ frame }: FrameInputs): { block: Vec2; at: Vec2; noise: Float } {
  const block = uv().mul(frame.marchedSize).floor().toConst() as unknown as Vec2
  const pixel = block.mul(frame.block).add(frame.jitter).min(frame.size.sub(1))
  const at = pixel.add(0.5).div(frame.size).toConst() as Vec2
  return { block, at, noise: blueNoise(pixel).add(frame.roundShift).fract().toConst() }
}
