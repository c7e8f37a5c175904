import { Vector3 } from 'three'
import { renderGroup, uniform } from 'three/tsl'
import type { UniformNode } from 'three/webgpu'
import type { Ellipsoid } from '@welkin/geo'
import { REFERENCE_STEP } from './noise/tsl/latticeNoise'
import type { Viewer } from './tiles/cpu/viewer'

type Scalar = UniformNode<'float', number>
type Vector = UniformNode<'vec3', Vector3>

// Uniforms of all that a camera renders: what is an object's own does not reach materials that three
// does not refresh.
const number = (value = 0): Scalar => uniform(value).setGroup(renderGroup)
const vector = (value = new Vector3()): Vector => uniform(value).setGroup(renderGroup)

const reference = new Vector3()

/** Uniforms of a terrain's shaders, for one viewer. ECEF axes. */
export class TerrainUniforms {
  /** Point near the viewer's subpoint in whole multiples of 256 m [256 m]. */
  readonly reference = vector()
  /** Reference to the point from which distances to tiles count [m]. */
  readonly datum = vector()
  /** Height of the ground below the viewer, from which others count [m]. */
  readonly groundHeight = number()
  /** Surface of the sea [m]; far below all ground where there is none. */
  readonly seaLevel = number()
  /** Radii of the ellipsoid [m]. */
  readonly radii: Vector
  /** Largest radius over each radius: where the ellipsoid is a sphere, but for size [–]. */
  readonly stretch: Vector

  constructor({ radii, maximumRadius }: Ellipsoid) {
    this.radii = vector(radii.clone())
    this.stretch = vector(new Vector3().setScalar(maximumRadius).divide(radii))
  }

  /** Reference in metres, for the CPU [m]. */
  referenceECEF(target: Vector3): Vector3 {
    return target.copy(this.reference.value).multiplyScalar(REFERENCE_STEP)
  }

  /** @param groundHeight - Below the viewer [m]. */
  update({ datumPoint }: Viewer, groundHeight: number): void {
    this.reference.value.copy(datumPoint).divideScalar(REFERENCE_STEP).round()
    this.datum.value.copy(datumPoint).sub(this.referenceECEF(reference))
    this.groundHeight.value = groundHeight
  }
}
