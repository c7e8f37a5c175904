import { Data3DTexture, DataUtils, HalfFloatType, LinearFilter, type TypedArray } from 'three'
import { texture3D } from 'three/tsl'
import type { UniformNode } from 'three/webgpu'
import { withDefaults, type ScatteringAngles } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import { checkRanges } from '../check'
import { parameterProperties } from '../parameterProperties'
import { fairWeatherPhase, scalePhase, type CloudPhaseParameters } from './cpu/cloudPhase'
import { slabTableForm } from './cpu/slabTableForm'
import { fillCloudLight } from './cpu/cloudLightTable'
import type { Float, LevelTexture, Vec3, Vec4 } from '../tsl-types'
import { number } from '../uniforms'

const ranges = {
  forwardAsymmetry: [0, 0.95],
  backwardAsymmetry: [-0.95, 0.95],
  forwardShare: [0, 1],
  scatteringAlbedo: [0, 0.99999]
} as const satisfies Record<keyof CloudPhaseParameters, readonly [number, number]>

/** Table and uniforms that the shader functions of cloud light read: see tsl/cloudLight.ts. */
export interface CloudLight {
  /** The table's 3-D texture; its layers as `fillCloudLight` says. */
  readonly table: LevelTexture<Vec3>
  /** 1 − ωf: what turns optical thicknesses and extinction into scaled ones. */
  readonly depthScale: UniformNode<'float', number>
  /** ω/(1 − ωf). */
  readonly scatteringScale: UniformNode<'float', number>
  /** 1 − g′, with g′ = χ′₁ the asymmetry of the delta-scaled phase function. */
  readonly oneMinusAsymmetry: UniformNode<'float', number>
  /** χ′₂, second Legendre coefficient of the delta-scaled phase function. */
  readonly secondMoment: UniformNode<'float', number>
  /** The lobes of the phase function: see {@link CloudPhaseParameters}. */
  readonly forwardAsymmetry: UniformNode<'float', number>
  readonly backwardAsymmetry: UniformNode<'float', number>
  readonly forwardShare: UniformNode<'float', number>
  /**
   * Light of particles on top of what the lobes scatter once, if they have fine structure: radiance per scaled extinction, for unit
   * irradiance above the cloud, at the four wavelengths [1/sr]. To be called inside of a shader function.
   */
  fineStructure?(sample: FineSampleNodes): Vec4
}

/** Sample in a cloud whose fine structure is asked for; depths are scaled optical depths τ′ = `depthScale` τ. */
export interface FineSampleNodes extends ScatteringAngles {
  /** Depth from the sample to the light. */
  readonly depthToLight: Float
  /** Depth from the camera to the sample. */
  readonly depthToCamera: Float
  /** Altitude of the sample [m]. */
  readonly altitude: Float
}

/**
 * Light scattered many times in clouds: the first three Legendre moments of its source in plane-parallel
 * slabs, by depth, thickness and angle of the light, and the same for light from the sky, for one phase function.
 *
 * Solved on the CPU in 28 steps of 2 to 5 ms (0.07 to 0.12 s in all, measured on a busy machine of two
 * cores); the same numbers on both backends; 0.24 MB on the GPU. Until the last step is
 * done the old table stands; before the first it is black.
 *
 * ```ts
 * const light = new CloudLightTable()
 * light.bake()                                   // or a step a frame: light.update(1)
 * ```
 */
export class CloudLightTable {
  readonly texture: Data3DTexture
  readonly nodes: CloudLight
  declare forwardAsymmetry: CloudPhaseParameters['forwardAsymmetry']
  declare backwardAsymmetry: CloudPhaseParameters['backwardAsymmetry']
  declare forwardShare: CloudPhaseParameters['forwardShare']
  declare scatteringAlbedo: CloudPhaseParameters['scatteringAlbedo']
  #phase: CloudPhaseParameters = fairWeatherPhase
  /** Steps left until the table is that of the phase function. */
  #steps: Generator<void, void, void> | null = null

  static {
    parameterProperties(CloudLightTable.prototype, fairWeatherPhase, 'phase')
  }

  /**
   * @param phase - Differences from droplets of fair-weather clouds.
   * @throws Error naming the parameter and its value when one is out of its range.
   */
  constructor(phase: Partial<CloudPhaseParameters> = {}) {
    const { positions, thicknesses, layers } = slabTableForm
    const texels = new Uint16Array(4 * positions * thicknesses * layers)
    this.texture = new Data3DTexture(texels, positions, thicknesses, layers)
    this.texture.name = 'Welkin.CloudLight'
    this.texture.type = HalfFloatType
    this.texture.minFilter = this.texture.magFilter = LinearFilter
    this.texture.needsUpdate = true
    this.nodes = {
      table: texture3D(this.texture) as unknown as LevelTexture<Vec3>,
      depthScale: number(),
      scatteringScale: number(),
      oneMinusAsymmetry: number(),
      secondMoment: number(),
      forwardAsymmetry: number(),
      backwardAsymmetry: number(),
      forwardShare: number()
    }
    this.set(phase)
    this.#apply()
  }

  /** The phase function: a frozen object, replaced by each `set`. */
  get phase(): CloudPhaseParameters {
    return this.#phase
  }

  /** True while the table is not yet that of the phase function. */
  get isDirty(): boolean {
    return this.#steps !== null
  }

  /** True once there is a table, of this phase function or the one before. */
  get isReady(): boolean {
    return this.texture.version > 1
  }

  /**
   * Changes the phase function; nothing changes when the result would not be valid. Light follows when
   * the table is solved.
   *
   * @throws Error naming the parameter and its value when one is out of its range.
   */
  set(changes: Partial<CloudPhaseParameters>): this {
    if ('dropletRadius' in changes) {
      fail('CloudLightTable', 'dropletRadius needs a DropletLightTable')
    }
    const phase = Object.freeze(withDefaults('CloudLightTable', this.#phase, changes))
    checkRanges('CloudLightTable', phase, ranges)
    this.#phase = phase
    this.#steps = this.#solve()
    return this
  }

  /** Sets the uniforms of the phase function. */
  #apply(): void {
    const { nodes, phase } = this
    const { depthScale, moments } = scalePhase(phase)
    nodes.depthScale.value = depthScale
    nodes.scatteringScale.value = phase.scatteringAlbedo / depthScale
    nodes.oneMinusAsymmetry.value = 1 - moments[1]
    nodes.secondMoment.value = moments[2]
    for (const name of ['forwardAsymmetry', 'backwardAsymmetry', 'forwardShare'] as const) {
      nodes[name].value = phase[name]
    }
  }

  *#solve(): Generator<void, void, void> {
    const texels = this.texture.image.data as TypedArray
    const data = new Float32Array(texels.length)
    yield* fillCloudLight(this.#phase, data)
    data.forEach((value, i) => (texels[i] = DataUtils.toHalfFloat(value)))
    this.texture.needsUpdate = true
    this.#apply()
    this.#steps = null
  }

  /**
   * Goes on with the table, if the phase function has changed.
   *
   * @param steps - Most steps to take, of 29: one for each of 28 thicknesses, and the upload.
   */
  update(steps = Infinity): void {
    for (let i = 0; i < steps && this.#steps !== null; i++) this.#steps.next()
  }

  /** Computes the table at once, if the phase function has changed. */
  bake(): void {
    this.update()
  }

  /** Frees the table. */
  dispose(): void {
    this.texture.dispose()
  }
}
