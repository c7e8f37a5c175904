import { Fn, dot } from 'three/tsl'
import type { Node } from 'three/webgpu'

/**
 * Height above a sphere of a point given by its offset from the eye, without the cancellation of
 * |p| − R: with r_c = R + h_c, r − r_c = (2 r_c (d·up) + |d|²) / (r + r_c).
 *
 * @param offset - Eye to point, d, in the mapped space [m].
 * @param up - The eye's unit up in the mapped space.
 * @param eyeHeight - Of the eye above the sphere, h_c [m].
 * @param radius - Of the sphere, R [m].
 * @returns [m].
 * @see Twin: test/twins/offsetHeight.ts
 */
export const offsetHeight = /*#__PURE__*/ Fn(
  ([offset, up, eyeHeight, radius]: [Node<'vec3'>, Node<'vec3'>, Node<'float'>, Node<'float'>]) => {
    const eyeRadius = radius.add(eyeHeight).toConst('eyeRadius')
    const gain = eyeRadius.mul(2).mul(dot(offset, up)).add(dot(offset, offset)).toConst('gain')
    const pointRadius = eyeRadius.mul(eyeRadius).add(gain).max(0).sqrt()
    return eyeHeight.add(gain.div(pointRadius.add(eyeRadius)))
  },
  {
    name: 'offsetHeight',
    type: 'float',
    inputs: [
      { name: 'offset', type: 'vec3' },
      { name: 'up', type: 'vec3' },
      { name: 'eyeHeight', type: 'float' },
      { name: 'radius', type: 'float' }
    ]
  }
)
