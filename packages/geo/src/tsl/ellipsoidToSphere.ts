import { Fn } from 'three/tsl'
import type { Node } from 'three/webgpu'

/**
 * The map that takes an ellipsoid to a sphere of radius a: a product by component. Linear, so it
 * serves positions and displacements; normalize what must be a unit direction.
 *
 * @param vector - ECEF position or displacement [m], or a direction.
 * @param scale - a / radii, `sphereScale(ellipsoid)`.
 * @returns The same in the mapped space.
 * @see Twin: Ellipsoid.toSphere
 */
export const ellipsoidToSphere = /*#__PURE__*/ Fn(
  ([vector, scale]: [Node<'vec3'>, Node<'vec3'>]) => vector.mul(scale),
  {
    name: 'ellipsoidToSphere',
    type: 'vec3',
    inputs: [
      { name: 'vector', type: 'vec3' },
      { name: 'scale', type: 'vec3' }
    ]
  }
)
