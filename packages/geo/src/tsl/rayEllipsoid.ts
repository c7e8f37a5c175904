import { Fn, dot, float, select } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { ellipsoidToSphere } from './ellipsoidToSphere'

/**
 * Distance along a ray to where it first meets a sphere; from inside, to where it leaves.
 *
 * With the ray's origin given by its height, c = |p|² − R² = h (2R + h) keeps its digits in float32:
 * at 2 m above the Earth the subtraction would leave none of them.
 *
 * @param height - Of the ray's origin above the sphere, negative inside [m].
 * @param radius - Of the sphere [m].
 * @param cosView - Cosine between the ray and the sphere's up at its origin, in [−1, 1].
 * @returns [m], or −1 if the ray misses.
 * @see Twin: test/twins/rayEllipsoid.ts
 */
export const raySphere = /*#__PURE__*/ Fn(
  ([height, radius, cosView]: [Node<'float'>, Node<'float'>, Node<'float'>]) => {
    const towards = radius.add(height).mul(cosView).negate().toConst('towards')
    const outside = height.mul(radius.mul(2).add(height)).toConst('outside')
    const discriminant = towards.mul(towards).sub(outside).toConst('discriminant')
    const root = discriminant.max(0).sqrt().toConst('root')
    // Outside, the nearer root: the product of the roots over the farther one. Inside, the farther.
    const near = outside.div(towards.add(root).max(1e-30)).toConst('near')
    const far = towards
      .greaterThan(0)
      .select(towards.add(root), outside.negate().div(root.sub(towards).max(1e-30)))
      .toConst('far')
    const misses = discriminant.lessThan(0).or(height.greaterThan(0).and(towards.lessThan(0)))
    return select(misses, float(-1), select(height.greaterThan(0), near, far.max(0)))
  },
  {
    name: 'raySphere',
    type: 'float',
    inputs: [
      { name: 'height', type: 'float' },
      { name: 'radius', type: 'float' },
      { name: 'cosView', type: 'float' }
    ]
  }
)

/**
 * Distance along a ray to where it first meets an ellipsoid; from inside, to where it leaves.
 *
 * The eye comes as float64 on the CPU found it in the mapped space: `sphereEye(ellipsoid, position)`.
 *
 * @param direction - Unit, ECEF axes.
 * @param scale - a / radii, `sphereScale(ellipsoid)`.
 * @param up - The eye's unit up in the mapped space.
 * @param height - The eye's height above the mapped sphere [m].
 * @param radius - Of the mapped sphere, a [m].
 * @returns [m] in ECEF, or −1 if the ray misses.
 * @see Twin: Ellipsoid.intersectRayDistance
 */
export const rayEllipsoid = /*#__PURE__*/ Fn(
  ([direction, scale, up, height, radius]: [
    Node<'vec3'>,
    Node<'vec3'>,
    Node<'vec3'>,
    Node<'float'>,
    Node<'float'>
  ]) => {
    const mapped = ellipsoidToSphere(direction, scale).toConst('mapped')
    const stretch = mapped.length().toConst('stretch')
    const distance = raySphere(height, radius, dot(mapped, up).div(stretch)).toConst('distance')
    return select(distance.lessThan(0), float(-1), distance.div(stretch))
  },
  {
    name: 'rayEllipsoid',
    type: 'float',
    inputs: [
      { name: 'direction', type: 'vec3' },
      { name: 'scale', type: 'vec3' },
      { name: 'up', type: 'vec3' },
      { name: 'height', type: 'float' },
      { name: 'radius', type: 'float' }
    ]
  }
)
