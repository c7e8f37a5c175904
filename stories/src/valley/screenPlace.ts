import { max, vec2 } from 'three/tsl'
import type { Node } from 'three/webgpu'

/** Place on the screen of a point in clip space, from the top left. */
export function screenPlace(clip: Node<'vec4'>): Node<'vec2'> {
  const place = clip.xy.div(max(clip.w, 1e-3))
  return vec2(place.x, place.y.negate()).mul(0.5).add(0.5)
}
