import { Vector3 } from 'three'
import { numberUniform as number, vector3Uniform as vector } from '@welkin/atmosphere'
import { REFERENCE_STEP } from './noise/tsl/latticeNoise'
import type { Figure } from './tiles/cpu/figure'
import type { Viewer } from './tiles/cpu/viewer'

const reference = new Vector3()

/**
 * Distance up to which flat ground has triangles twice as large: so far [m], plus so many times the viewer's height [–]. Greater: the glow
 * of a low sun at the horizon, which is found at vertices, is coarse.
 */
const FLAT_UNTIL = 2000
const FLAT_PER_HEIGHT = 100

/** Uniforms of a terrain's shaders, for one viewer. ECEF axes. */
export class TerrainUniforms {
  /** Point near the viewer's subpoint in whole multiples of 256 m [256 m]. */
  readonly reference = vector()
  /** Reference to the point from which distances to tiles count [m]. */
  readonly datum = vector()
  /** Height of the ground below the viewer, from which other heights count [m]. */
  readonly groundHeight = number()
  /** Surface of the sea [m]; far below all ground where there is none. */
  readonly seaLevel = number()
  /** Variance of the sea's slopes. */
  readonly seaVariance = number()
  /** Time of the waves [s]. */
  readonly waveTime = number()
  /** Upper bound of the ground near the viewer, who might be under coarse ground otherwise while pages are missing [m]. */
  readonly ceiling = number()
  /** Depth of the skirt about a tile [cells]: more where levels of neighbours differ while pages are missing. */
  readonly skirt = number(1)
  /** Distance up to which triangles are twice as large on flat ground; twice as far none is [m]. */
  readonly flatUntil = number()
  /** Factor on the colours of imagery [–]. */
  readonly imageAlbedo = number(1)
  /** Radii of the ellipsoid [m]. */
  readonly radii = vector()
  /** Largest radius over each radius, which stretches the ellipsoid to a sphere [–]. */
  readonly stretch = vector()

  /** Unit vector to the north pole, from which latitude counts; in a flat world as seen from its place. */
  readonly pole = vector()

  constructor({ radii, maximumRadius }: Figure) {
    this.radii.value.copy(radii)
    this.stretch.value.setScalar(maximumRadius).divide(radii)
  }

  /** Reference in metres, for the CPU [m]. */
  referenceECEF(target: Vector3): Vector3 {
    return target.copy(this.reference.value).multiplyScalar(REFERENCE_STEP)
  }

  /**
   * @param groundHeight - Below the viewer [m].
   * @param pole - Unit vector to the north pole.
   */
  update({ datumPoint, clearance }: Viewer, groundHeight: number, pole: Vector3): void {
    this.pole.value.copy(pole)
    this.reference.value.copy(datumPoint).divideScalar(REFERENCE_STEP).round()
    this.datum.value.copy(datumPoint).sub(this.referenceECEF(reference))
    this.groundHeight.value = groundHeight
    this.flatUntil.value = FLAT_UNTIL + FLAT_PER_HEIGHT * clearance
  }
}
