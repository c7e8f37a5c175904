import type { HeightSource } from '@welkin/terrain'
import { vec4 } from 'three/tsl'

/** Level ground. */
export const levelGround: HeightSource = {
  lowest: 0,
  highest: 0,
  variation: () => 0,
  sampleAt(_, target) {
    target.height = 0
    target.gradient.set(0, 0, 0)
    return target
  },
  sample: () => vec4(0)
}
