import type { TextureNode } from 'three/webgpu'
import type { Vec2, Vec4 } from '../../tsl-types'

/** Texture node whose samples take gradients, so that it can be read inside a branch. */
export type GradientSampler = TextureNode & {
  sample(uv: Vec2): { grad(x: Vec2, y: Vec2): Vec4 }
}
